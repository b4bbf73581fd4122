# SPDX-License-Identifier: GPL-3.0-or-later
# folder_sources(OUT SOURCES...): for each folder of the sources one file that includes all of them. Most of a compiler's
# time goes into the headers that they share: `curvature` takes 66 seconds for 158. For work on one file
# DF_WHOLE_FOLDERS=OFF compiles each by itself, which also shows where an include is missing.
option(DF_WHOLE_FOLDERS "Compile all sources of a folder together" ON)

function(folder_sources out)
  if(NOT DF_WHOLE_FOLDERS)
    set(${out} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  set(folders "")
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "whole_${folder}" name)
    list(APPEND folders ${name})
    list(APPEND in_${name} ${source})
    string(APPEND text_${name} "#include \"${source}\"\n") # a path below native/: all clones compile the same bytes
  endforeach()
  list(REMOVE_DUPLICATES folders)
  set(made "")
  foreach(name IN LISTS folders)
    list(LENGTH in_${name} count)
    if(count EQUAL 1)
      list(APPEND made ${in_${name}})
      continue()
    endif()
    set(path ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    file(CONFIGURE OUTPUT ${path} CONTENT "${text_${name}}" @ONLY) # written only if it changes
    list(APPEND made ${path})
  endforeach()
  set(${out} ${made} PARENT_SCOPE)
endfunction()
