# Installation and the package vmesh: one export set per module, so that a consumer needs only the libraries of the
# modules it requests. The package's dependencies follow from what the modules link.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(vmesh_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/vmesh")

# The find_dependency() call that provides the linked target LIBRARY.
function(vmesh_dependency_of library out)
  if(library STREQUAL "Eigen3::Eigen")
    set(call "Eigen3 3.4 NO_MODULE")
  elseif(library STREQUAL "assimp::assimp")
    set(call "assimp 5.2")
  elseif(library STREQUAL "hdf5::hdf5")
    set(call "HDF5 1.10 COMPONENTS C")
  elseif(library STREQUAL "meshoptimizer::meshoptimizer")
    set(call "meshoptimizer")
  elseif(library MATCHES "^gdcm")
    set(call "GDCM 3")
  elseif(library STREQUAL "embree")
    set(call "embree ${embree_VERSION_MAJOR}")
  elseif(library STREQUAL "PNG::PNG")
    set(call "PNG")
  elseif(library STREQUAL "TIFF::TIFF")
    set(call "TIFF 4.5")
  elseif(library STREQUAL "ZLIB::ZLIB")
    set(call "ZLIB")
  elseif(library STREQUAL "pugixml::pugixml")
    set(call "pugixml")
  elseif(library STREQUAL "Threads::Threads")
    set(call "Threads")
  elseif(library STREQUAL "TBB::tbb")
    set(call "TBB 2021")
  else()
    message(FATAL_ERROR "libvmesh/cmake/install.cmake does not know which package provides ${library}; "
      "add it, or link it as $<BUILD_INTERFACE:${library}> when consumers need not link it")
  endif()
  set(${out} "${call}" PARENT_SCOPE)
endfunction()

# Sets links_NAME (modules) and dependencies_NAME (find_dependency calls, separated by |) from what module NAME links.
function(vmesh_inspect_links name)
  get_target_property(libraries vmesh_${name} LINK_LIBRARIES)
  set(modules "")
  set(calls "")
  foreach(library IN LISTS libraries)
    if(library MATCHES "^vmesh::(.*)$")
      list(APPEND modules ${CMAKE_MATCH_1})
    elseif(library MATCHES "BUILD_INTERFACE:CGAL::CGAL")
      # CGAL is header-only, but the libraries that it calls must be linked.
      target_link_libraries(vmesh_${name} PRIVATE $<INSTALL_INTERFACE:mpfr> $<INSTALL_INTERFACE:gmp>)
    elseif(library AND NOT library MATCHES "^\\$<")
      vmesh_dependency_of("${library}" call)
      list(APPEND calls "${call}")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES calls)
  list(JOIN calls "|" calls)
  set(links_${name} "${modules}" PARENT_SCOPE)
  set(dependencies_${name} "${calls}" PARENT_SCOPE)
endfunction()

function(vmesh_install_module name)
  install(TARGETS vmesh_${name} EXPORT vmesh-${name} ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    COMPONENT development)
  install(EXPORT vmesh-${name} NAMESPACE vmesh:: DESTINATION "${vmesh_package_dir}" COMPONENT development)
  install(DIRECTORY include/vmesh/${name} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/vmesh" COMPONENT development
    FILES_MATCHING PATTERN "*.h")
endfunction()

# To be called with all modules in the order of the link graph: a module's dependencies come before it.
function(vmesh_install_package)
  set(graph "")
  foreach(module IN LISTS ARGN)
    vmesh_inspect_links(${module})
    vmesh_install_module(${module})
    string(APPEND graph "set(_vmesh_links_${module} \"${links_${module}}\")\n"
      "set(_vmesh_dependencies_${module} \"${dependencies_${module}}\")\n")
  endforeach()
  set(VMESH_MODULES "${ARGN}")
  set(VMESH_GRAPH "${graph}")
  configure_package_config_file(cmake/vmeshConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/vmeshConfig.cmake"
    INSTALL_DESTINATION "${vmesh_package_dir}" NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/vmeshConfigVersion.cmake"
    VERSION "${PROJECT_VERSION}" COMPATIBILITY SameMinorVersion)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/vmeshConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/vmeshConfigVersion.cmake"
    DESTINATION "${vmesh_package_dir}" COMPONENT development)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md"
    DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT command)
  foreach(folder tools libvmesh libvmesh/python bench)  # where README.md goes on
    install(FILES "${PROJECT_SOURCE_DIR}/${folder}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}/${folder}"
      COMPONENT command)
  endforeach()
endfunction()
