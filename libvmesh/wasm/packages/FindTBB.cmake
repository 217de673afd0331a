# Loops one after the other, see ../tbb.
if(NOT TARGET TBB::tbb)
  add_library(vmesh_serial_tbb INTERFACE)
  target_include_directories(vmesh_serial_tbb SYSTEM INTERFACE "${CMAKE_CURRENT_LIST_DIR}/..")
  add_library(TBB::tbb ALIAS vmesh_serial_tbb)
endif()
set(TBB_FOUND TRUE)
