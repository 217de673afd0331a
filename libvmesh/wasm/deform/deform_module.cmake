# The module `deform` in WebAssembly, for pages that move (vmesh deform --live). The modules are small, so that em++
# compiles their sources at once, in a minute, with the flags of ../toolchain.cmake; nothing is configured anew.

# Sets `result` to a script, made from the sources of these modules, that defines createDeformer(): emscripten's module
# with the functions of exports.cpp, the WebAssembly in it in base64.
function(vmesh_add_deform_module em result)
  set(wasm "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/..")
  set(src "${PROJECT_SOURCE_DIR}/libvmesh/src")
  set(own "${CMAKE_CURRENT_FUNCTION_LIST_DIR}")
  set(sources "${own}/exports.cpp" "${own}/parted_tree.cpp")
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
  foreach(name core/box_tree core/instruction_set core/text
      # What cutting a surface takes.
      edit/crossing_guard edit/face_table
      mesh/check_indices mesh/close_faces mesh/defective_faces mesh/face_pair mesh/polygon_triangulation mesh/self_intersections mesh/topology mesh/tri_mesh mesh/triangle_quality
      mesh/vertex_corners
      surface/cut/cut_surface surface/cut/plane_loop surface/cut/plane_parting surface/cut/plane_snap surface/ends/disc
      surface/tubes/stitch)
    list(APPEND sources "${src}/${name}.cpp")
  endforeach()
  set(headers "")
  foreach(folder core mesh edit surface deform centerline)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS "${src}/${folder}/*.h" "${PROJECT_SOURCE_DIR}/libvmesh/include/vmesh/${folder}/*.h")
    list(APPEND headers ${found})
  endforeach()
  file(GLOB_RECURSE found CONFIGURE_DEPENDS "${wasm}/*.h")
  list(APPEND headers ${found})
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  include("${wasm}/packages/system_headers.cmake")
  vmesh_system_headers(vmesh_deformer_headers CGAL version.h)
  vmesh_system_headers(vmesh_deformer_headers boost version.hpp)
  get_target_property(system vmesh_deformer_headers INTERFACE_INCLUDE_DIRECTORIES)
  list(TRANSFORM system PREPEND "-isystem")
  # With the launcher of the other compiler, ccache for example.
  set(launcher "")
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    set(launcher "EM_COMPILER_WRAPPER=${CMAKE_CXX_COMPILER_LAUNCHER}")
  endif()
  set(script "${CMAKE_CURRENT_BINARY_DIR}/deformer.js")
  add_custom_command(OUTPUT "${script}" VERBATIM DEPENDS ${sources} ${headers}
    COMMENT "Deformation in WebAssembly"
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs:/usr/lib/nodejs ${launcher}
      "${em}" -std=c++20 -O3 -DNDEBUG
      -msimd128 -msse2 -fwasm-exceptions -ffp-contract=off -fno-math-errno -Wno-psabi -DVMESH_INSTRUCTION_SET=plain
      -DCGAL_DISABLE_GMP=1 -DCGAL_ALWAYS_ROUND_TO_NEAREST=1
      -isystem "${wasm}" -isystem "${wasm}/sse" -include "${wasm}/libcxx.h" -include "${wasm}/eigen.h" -isystem "${eigen}"
      ${system} "-I${PROJECT_SOURCE_DIR}/libvmesh/include" "-I${src}" ${sources} -o "${script}"
      -sSINGLE_FILE=1 -sMODULARIZE=1 -sEXPORT_NAME=createDeformer -sENVIRONMENT=web,node -sFILESYSTEM=0
      -sALLOW_MEMORY_GROWTH=1 -sTOTAL_STACK=1MB -sABORTING_MALLOC=0 "-sEXPORTED_FUNCTIONS=_malloc,_free"
      "-sEXPORTED_RUNTIME_METHODS=UTF8ToString")
  set(${result} "${script}" PARENT_SCOPE)
endfunction()
