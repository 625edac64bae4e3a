# find_package(hbvib) gives
#   hbvib::hbvib           the shared library with its C and C++ headers
#   hbvib::static          the static library with the same headers
#   hbvib_FORTRAN_MODULE   source of the Fortran module: add it to the sources of a target
#   hbvib_PYTHON_PATH      folder of the Python module
get_filename_component(_hbvib_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(hbvib_FORTRAN_MODULE "${_hbvib_prefix}/include/hbvib.f90")
set(hbvib_PYTHON_PATH "${_hbvib_prefix}/share/hbvib")

if(NOT TARGET hbvib::hbvib)
  add_library(hbvib::hbvib SHARED IMPORTED)
  set_target_properties(hbvib::hbvib PROPERTIES
    IMPORTED_LOCATION "${_hbvib_prefix}/lib/libhbvib.so.@VERSION@"
    IMPORTED_SONAME "libhbvib.so.@ABI@"
    INTERFACE_INCLUDE_DIRECTORIES "${_hbvib_prefix}/include")
  add_library(hbvib::static STATIC IMPORTED)
  set_target_properties(hbvib::static PROPERTIES
    IMPORTED_LOCATION "${_hbvib_prefix}/lib/libhbvib.a"
    INTERFACE_INCLUDE_DIRECTORIES "${_hbvib_prefix}/include"
    INTERFACE_LINK_LIBRARIES "gcc_s;util;rt;pthread;m;dl")
endif()
unset(_hbvib_prefix)
