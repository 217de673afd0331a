# For CMake: emscripten, Debian's or the one in EMSCRIPTEN_ROOT, and in packages/ what stands in for installed libraries.
if(DEFINED ENV{EMSCRIPTEN_ROOT})
  set(EMSCRIPTEN_ROOT_PATH "$ENV{EMSCRIPTEN_ROOT}")
else()
  set(EMSCRIPTEN_ROOT_PATH /usr/share/emscripten)
endif()
set(platform "${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake")
if(NOT EXISTS "${platform}")
  message(FATAL_ERROR "No emscripten in ${EMSCRIPTEN_ROOT_PATH}: scripts/install-dependencies --with-wasm, or name its "
    "folder in EMSCRIPTEN_ROOT")
endif()
include("${platform}")
list(PREPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}/packages")
# Eigen and nlohmann_json are headers only; the system's will do.
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
# Exceptions and vectors of WebAssembly's own: browsers of 2022 and later, Node from 17.
set(CMAKE_C_FLAGS_INIT "-msimd128")
string(CONCAT CMAKE_CXX_FLAGS_INIT "-msimd128 -msse2 -fwasm-exceptions -isystem ${CMAKE_CURRENT_LIST_DIR}/sse "
  "-include ${CMAKE_CURRENT_LIST_DIR}/libcxx.h -include ${CMAKE_CURRENT_LIST_DIR}/eigen.h")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fwasm-exceptions")
set(VMESH_WASM_SOURCES "${CMAKE_CURRENT_LIST_DIR}/../../build/wasm-sources" CACHE PATH
    "zlib and pugixml, which scripts/wasm gets")
