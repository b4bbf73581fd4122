# SPDX-License-Identifier: GPL-3.0-or-later
# zig's clang, with the libraries of the platform that DF_ZIG_TARGET names. cross/native_build.py calls this and says
# where zig is.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES DF_ZIG DF_ZIG_TARGET)

if(DF_ZIG_TARGET MATCHES "-windows-")
  set(CMAKE_SYSTEM_NAME Windows)
elseif(DF_ZIG_TARGET MATCHES "-macos")
  set(CMAKE_SYSTEM_NAME Darwin)
  set(CMAKE_OSX_SYSROOT "" CACHE STRING "zig has its own") # or CMake asks for Xcode
else()
  set(CMAKE_SYSTEM_NAME Linux)
endif()
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR ${DF_ZIG_TARGET})

set(CMAKE_TRY_COMPILE_CONFIGURATION Release)
foreach(language IN ITEMS C CXX)
  set(CMAKE_${language}_COMPILER_LAUNCHER "" CACHE STRING "ccache does not know zig")
  # zig builds its own libraries once for each combination of these, which takes minutes: one for all
  set(CMAKE_${language}_FLAGS_RELEASE_INIT "-O2 -g0")
  set(CMAKE_${language}_FLAGS_INIT "-target ${DF_ZIG_TARGET}")
endforeach()
set(CMAKE_C_COMPILER ${DF_ZIG} cc)
set(CMAKE_CXX_COMPILER ${DF_ZIG} c++)
# programs of one word each, which cross/sources.py writes beside zig
set(CMAKE_AR ${DF_ZIG}-ar CACHE FILEPATH "`zig ar`")
set(CMAKE_RANLIB ${DF_ZIG}-ranlib CACHE FILEPATH "`zig ranlib`")
set(CMAKE_RC_COMPILER ${DF_ZIG} CACHE FILEPATH "has nothing to do here, but has to exist")
set(CMAKE_CXX_SCAN_FOR_MODULES OFF)

# programs are this machine's; so are Eigen's and pybind11's headers, which are the same everywhere
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
