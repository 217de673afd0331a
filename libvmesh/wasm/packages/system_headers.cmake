# Adds TARGET, the headers NAME of the system (/usr/include/NAME), which contains PROBE. They are linked to, so that
# nothing else of /usr/include is found before emscripten's own.
function(vmesh_system_headers target name probe)
  find_path(VMESH_HEADERS_OF_${name} "${name}/${probe}" PATHS /usr/include REQUIRED NO_CMAKE_FIND_ROOT_PATH)
  set(headers "${CMAKE_BINARY_DIR}/headers/${name}")
  file(MAKE_DIRECTORY "${headers}")
  file(CREATE_LINK "${VMESH_HEADERS_OF_${name}}/${name}" "${headers}/${name}" SYMBOLIC)
  if(NOT TARGET ${target})
    add_library(${target} INTERFACE)
  endif()
  target_include_directories(${target} SYSTEM INTERFACE "${headers}")
endfunction()
