# Headers of the system.
if(NOT TARGET nlohmann_json::nlohmann_json)
  include("${CMAKE_CURRENT_LIST_DIR}/system_headers.cmake")
  vmesh_system_headers(vmesh_nlohmann_json nlohmann json.hpp)
  add_library(nlohmann_json::nlohmann_json ALIAS vmesh_nlohmann_json)
endif()
set(nlohmann_json_FOUND TRUE)
