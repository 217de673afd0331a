# The module `deform` in WebAssembly, for pages that move (vmesh deform --live). Three modules are small, so that em++
# compiles their sources at once, in half a minute, with the flags of ../toolchain.cmake; nothing is configured anew.

# Sets `result` to a script, made from the sources of these modules, that defines createDeformer(): emscripten's module
# with the functions of exports.cpp, the WebAssembly in it in base64.
function(vmesh_add_deform_module em result)
  set(wasm "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/..")
  set(sources "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/exports.cpp")
  set(modules vmesh_deform vmesh_deform_plain vmesh_centerline)
  foreach(module IN LISTS modules)
    get_target_property(names ${module} SOURCES)
    get_target_property(folder ${module} SOURCE_DIR)
    list(FILTER names INCLUDE REGEX "^[a-z_0-9]+\\.cpp$")
    list(TRANSFORM names PREPEND "${folder}/")
    list(APPEND sources ${names})
  endforeach()
  # Files of other kinds than surfaces.
  list(FILTER sources EXCLUDE REGEX "/(linear_skin|volume_places)\\.cpp$")
  foreach(name box_tree instruction_set text)
    list(APPEND sources "${PROJECT_SOURCE_DIR}/libvmesh/src/core/${name}.cpp")
  endforeach()
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/libvmesh/src/deform/*.h" "${wasm}/*.h"
    "${PROJECT_SOURCE_DIR}/libvmesh/include/vmesh/core/*.h" "${PROJECT_SOURCE_DIR}/libvmesh/include/vmesh/mesh/*.h"
    "${PROJECT_SOURCE_DIR}/libvmesh/include/vmesh/deform/*.h"
    "${PROJECT_SOURCE_DIR}/libvmesh/include/vmesh/centerline/*.h")
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  set(script "${CMAKE_CURRENT_BINARY_DIR}/deformer.js")
  add_custom_command(OUTPUT "${script}" VERBATIM DEPENDS ${sources} ${headers}
    COMMENT "Deformation in WebAssembly"
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs:/usr/lib/nodejs "${em}" -std=c++20 -O3 -DNDEBUG
      -msimd128 -msse2 -fwasm-exceptions -ffp-contract=off -fno-math-errno -Wno-psabi -DVMESH_INSTRUCTION_SET=plain
      -isystem "${wasm}/sse" -include "${wasm}/libcxx.h" -include "${wasm}/eigen.h" -isystem "${eigen}"
      "-I${PROJECT_SOURCE_DIR}/libvmesh/include" "-I${PROJECT_SOURCE_DIR}/libvmesh/src" ${sources} -o "${script}"
      -sSINGLE_FILE=1 -sMODULARIZE=1 -sEXPORT_NAME=createDeformer -sENVIRONMENT=web,node -sFILESYSTEM=0
      -sALLOW_MEMORY_GROWTH=1 -sTOTAL_STACK=1MB -sABORTING_MALLOC=0 "-sEXPORTED_FUNCTIONS=_malloc,_free"
      "-sEXPORTED_RUNTIME_METHODS=UTF8ToString")
  set(${result} "${script}" PARENT_SCOPE)
endfunction()
