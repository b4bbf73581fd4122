# SPDX-License-Identifier: GPL-3.0-or-later
# `fairing_flags`: what every one of our own targets is compiled with, and nobody else's.
add_library(fairing_flags INTERFACE)
target_compile_features(fairing_flags INTERFACE cxx_std_20)

if(WIN32 AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  message(FATAL_ERROR "GCC spills packs of 32 bytes to a stack of 16 on Windows (its bug 54412): compile with Clang.")
endif()

# Baseline instructions and no fused multiply-add: the two instruction sets of an inner loop give the same bits.
if(MSVC) # its Clang, which takes the options in Microsoft's spelling
  target_compile_options(fairing_flags INTERFACE /clang:-ffp-contract=off /clang:-fno-math-errno /W4 /utf-8 /bigobj)
else()
  target_compile_options(fairing_flags INTERFACE -ffp-contract=off -fno-math-errno -Wall -Wextra)
  # no folder of this machine in what is made: any other makes the same bytes
  target_compile_options(fairing_flags INTERFACE -ffile-prefix-map=${CMAKE_SOURCE_DIR}=.)
  # a constructor's parameter may be called as the member it sets: GCC's plain -Wshadow objects, Clang's does not
  target_compile_options(fairing_flags INTERFACE $<IF:$<CXX_COMPILER_ID:GNU>,-Wshadow=local,-Wshadow>)
endif()
# Eigen's blocks, and so the order of its sums, depend on the machine's caches: on all machines as for these.
target_compile_definitions(
  fairing_flags INTERFACE EIGEN_NO_CPUID EIGEN_DEFAULT_L1_CACHE_SIZE=32768 EIGEN_DEFAULT_L2_CACHE_SIZE=262144
                          EIGEN_DEFAULT_L3_CACHE_SIZE=2097152)
if(WIN32) # whatever the compiler: M_PI, and std::min beside Windows' own headers
  target_compile_definitions(fairing_flags INTERFACE _USE_MATH_DEFINES NOMINMAX)
endif()
if(APPLE) # whose threads have stacks of 512 KB: what Eigen would lay there goes to the heap sooner than by default
  target_compile_definitions(fairing_flags INTERFACE EIGEN_STACK_ALLOCATION_LIMIT=32768)
endif()
# these look into inlined library code, and GCC 12 to 14 find there what cannot happen
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(fairing_flags INTERFACE -Wno-array-bounds -Wno-free-nonheap-object
                                                 -Wno-stringop-overflow -Wno-stringop-overread)
endif()
if(DF_WARNINGS_AS_ERRORS)
  target_compile_options(fairing_flags INTERFACE $<IF:$<BOOL:${MSVC}>,/WX,-Werror>)
endif()

target_compile_definitions(fairing_flags INTERFACE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)

if(DF_SANITIZE)
  target_compile_options(fairing_flags INTERFACE -fsanitize=${DF_SANITIZE} -fno-sanitize-recover=all
                                                 -fno-omit-frame-pointer)
  target_link_options(fairing_flags INTERFACE -fsanitize=${DF_SANITIZE})
endif()
