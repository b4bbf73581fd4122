# SPDX-License-Identifier: GPL-3.0-or-later
# OpenMeshCore: the machine's own library, or of its sources what we use, linked in, if DF_OPENMESH_SOURCE has them.
set(DF_OPENMESH_SOURCE "" CACHE PATH "OpenMesh's unpacked sources, to be linked in; empty: the installed library")

if(NOT DF_OPENMESH_SOURCE)
  find_package(OpenMesh REQUIRED CONFIG) # 9 to 11; the package has no version file
  return()
endif()

set(core ${DF_OPENMESH_SOURCE}/src/OpenMesh/Core)
file(GLOB openmesh_sources CONFIGURE_DEPENDS ${core}/Mesh/*.cc ${core}/System/*.cc ${core}/Utils/*.cc)
if(NOT openmesh_sources)
  message(FATAL_ERROR "DF_OPENMESH_SOURCE is ${DF_OPENMESH_SOURCE}, where OpenMesh's sources are not.")
endif()
add_library(OpenMeshCore STATIC ${openmesh_sources})
# as another project's: its headers give no warnings
target_include_directories(OpenMeshCore SYSTEM PUBLIC ${DF_OPENMESH_SOURCE}/src)
target_compile_features(OpenMeshCore PUBLIC cxx_std_20)
target_compile_definitions(OpenMeshCore PUBLIC OM_STATIC_BUILD $<$<BOOL:${WIN32}>:_USE_MATH_DEFINES;NOMINMAX>)
target_compile_options(OpenMeshCore PRIVATE -w)
set_target_properties(
  OpenMeshCore
  PROPERTIES POSITION_INDEPENDENT_CODE ON
             CXX_VISIBILITY_PRESET hidden
             VISIBILITY_INLINES_HIDDEN ON)
