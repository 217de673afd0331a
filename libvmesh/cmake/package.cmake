# Debian packages, by cpack (see scripts/package): vmesh, the command; libvmesh-dev, the library; python3-vmesh.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vmesh)
set(CPACK_PACKAGE_CONTACT "The developers of vmesh <vmesh@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_COMPONENTS_ALL command development)
if(VMESH_WITH_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()

# Dependencies of the command and the module follow from the shared libraries that they load.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME vmesh)
set(CPACK_COMPONENT_COMMAND_DESCRIPTION
  "Vessel centerlines to surfaces
Turns centerlines of vessels, points with radii, into closed triangle meshes,
fits them to segmentations, measures and deforms them. With manual pages and
completion for bash, zsh and fish.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libvmesh-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)  # static libraries tell nothing
# Every module needs the first; the others are needed only by some modules.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libgmp-dev, libmpfr-dev, libtbb-dev")
set(recommended libembree-dev libpng-dev libpugixml-dev zlib1g-dev)
if(VMESH_WITH_ASSIMP)
  list(APPEND recommended libassimp-dev)
endif()
if(VMESH_WITH_HDF5)
  list(APPEND recommended libhdf5-dev)
endif()
if(VMESH_HAS_DICOM)
  list(APPEND recommended libgdcm-dev)
endif()
if(VMESH_HAS_TIFF)
  list(APPEND recommended libtiff-dev)
endif()
if(VMESH_HAS_MESHOPTIMIZER)
  list(APPEND recommended libmeshoptimizer-dev)
endif()
if(VMESH_HAS_TETGEN)
  list(APPEND recommended libtet1.5-dev)
endif()
list(JOIN recommended ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Vessel centerlines to surfaces: library for C++
Static libraries, headers and the CMake package vmesh. Modules need some of the
recommended packages; that of CMake names what is missing.")

if(VMESH_WITH_PYTHON)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vmesh)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~), \
python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-vtk9")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    "${CMAKE_CURRENT_LIST_DIR}/debian/postinst" "${CMAKE_CURRENT_LIST_DIR}/debian/prerm")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "Vessel centerlines to surfaces: Python
The package vmesh: centerlines and surfaces as NumPy arrays, generated, fitted,
measured and deformed.")
endif()

include(GNUInstallDirs)
# Debian expects the license there.
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libvmesh-dev"
  RENAME copyright COMPONENT development)
if(VMESH_WITH_PYTHON AND NOT SKBUILD)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/python3-vmesh"
    RENAME copyright COMPONENT python)
endif()
include(CPack)
