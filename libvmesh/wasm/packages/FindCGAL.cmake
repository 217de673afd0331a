# CGAL's headers and those of Boost, of the system. Exact numbers are CGAL's own, there being no GMP here; WebAssembly
# rounds to nearest only, for which CGAL widens its intervals.
if(NOT TARGET CGAL::CGAL)
  include("${CMAKE_CURRENT_LIST_DIR}/system_headers.cmake")
  vmesh_system_headers(vmesh_cgal CGAL version.h)
  vmesh_system_headers(vmesh_cgal boost version.hpp)
  target_compile_definitions(vmesh_cgal INTERFACE CGAL_DISABLE_GMP=1 CGAL_ALWAYS_ROUND_TO_NEAREST=1)
  add_library(CGAL::CGAL ALIAS vmesh_cgal)
endif()
set(CGAL_FOUND TRUE)
