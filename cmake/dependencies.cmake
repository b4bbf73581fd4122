# SPDX-License-Identifier: GPL-3.0-or-later
# Eigen, nanoflann and OpenMesh: the machine's own, or their official sources at a hash, linked in.
# Without a network: -DFETCHCONTENT_SOURCE_DIR_EIGEN3=…, …_NANOFLANN=… and …_OPENMESH=… name folders of unpacked sources.
option(DF_FETCH "Fetch Eigen, nanoflann and OpenMesh where the machine has none" ON)

if(NOT DF_FETCH)
  find_package(Eigen3 REQUIRED CONFIG) # 3.4 and 5 alike, so no version range
  find_package(nanoflann REQUIRED CONFIG) # from 1.4 on
  find_package(OpenMesh REQUIRED CONFIG) # 9 to 11; the package has no version file
  return()
endif()

include(FetchContent)
# their own CMake files are left alone: they build tests, programs and shared libraries
FetchContent_Declare(
  Eigen3
  URL https://gitlab.com/libeigen/eigen/-/archive/3.4.0/eigen-3.4.0.tar.bz2
  URL_HASH SHA256=b4c198460eba6f28d34894e3a5710998818515104d6e74e5cc331ce31e46e626
  DOWNLOAD_EXTRACT_TIMESTAMP ON
  SOURCE_SUBDIR headers-alone
  FIND_PACKAGE_ARGS CONFIG)
FetchContent_Declare(
  nanoflann
  URL https://github.com/jlblancoc/nanoflann/archive/refs/tags/v1.4.2.tar.gz
  URL_HASH SHA256=97fce650eb644a359a767af526cab9ba31842e53790a7279887e1ae2fffe7319
  DOWNLOAD_EXTRACT_TIMESTAMP ON
  SOURCE_SUBDIR header-alone
  FIND_PACKAGE_ARGS CONFIG)
FetchContent_Declare(
  OpenMesh
  URL https://www.graphics.rwth-aachen.de/media/openmesh_static/Releases/11.0/OpenMesh-11.0.0.tar.gz
  URL_HASH SHA256=c7f35d29673e6dbb6d65b214c10c4c6249521a8f1e8f8db6e8bdc2eed798aedc
  DOWNLOAD_EXTRACT_TIMESTAMP ON
  SOURCE_SUBDIR core-alone
  FIND_PACKAGE_ARGS CONFIG)
FetchContent_MakeAvailable(Eigen3 nanoflann OpenMesh)

if(NOT TARGET Eigen3::Eigen)
  add_library(Eigen3::Eigen INTERFACE IMPORTED GLOBAL)
  target_include_directories(Eigen3::Eigen SYSTEM INTERFACE ${eigen3_SOURCE_DIR})
endif()

if(NOT TARGET nanoflann::nanoflann)
  add_library(nanoflann::nanoflann INTERFACE IMPORTED GLOBAL)
  target_include_directories(nanoflann::nanoflann SYSTEM INTERFACE ${nanoflann_SOURCE_DIR}/include)
endif()

if(NOT TARGET OpenMeshCore)
  set(core ${openmesh_SOURCE_DIR}/src/OpenMesh/Core)
  file(GLOB openmesh_sources ${core}/Mesh/*.cc ${core}/System/*.cc ${core}/Utils/*.cc)
  if(NOT openmesh_sources)
    message(FATAL_ERROR "OpenMesh's sources are not in ${openmesh_SOURCE_DIR}.")
  endif()
  add_library(OpenMeshCore STATIC ${openmesh_sources})
  # as another project's: its headers give no warnings
  target_include_directories(OpenMeshCore SYSTEM PUBLIC ${openmesh_SOURCE_DIR}/src)
  target_compile_features(OpenMeshCore PUBLIC cxx_std_20)
  target_compile_definitions(OpenMeshCore PUBLIC OM_STATIC_BUILD $<$<BOOL:${WIN32}>:_USE_MATH_DEFINES;NOMINMAX>)
  target_compile_options(OpenMeshCore PRIVATE -w)
  set_target_properties(
    OpenMeshCore
    PROPERTIES POSITION_INDEPENDENT_CODE ON
               CXX_VISIBILITY_PRESET hidden
               VISIBILITY_INLINES_HIDDEN ON)
endif()
