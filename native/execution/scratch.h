// SPDX-License-Identifier: GPL-3.0-or-later
// Buffers of the calling thread, kept from call to call: to get and clear large ones anew in every pass costs as much as the
// pass. They go with the thread; the one that owns the Workers gives its own back with them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fairing {

template <class T>
struct ThreadScratch {
  std::vector<T> closed;    // accumulate()'s: a closed face
  std::vector<T> run;       // an edge's points
  std::vector<T> work;      // what a body works in
  std::vector<T> gathered;  // closed faces that a body reads
  std::vector<T> columns;   // what a block of rows reads
};

template <class T>
ThreadScratch<T>& thread_scratch() {
  thread_local ThreadScratch<T> own;
  return own;
}

// Room for `size` numbers, whatever they are.
template <class T>
T* room_in(std::vector<T>& buffer, std::size_t size) {
  if (buffer.size() < size) buffer.resize(size);
  return buffer.data();
}

// Which columns of a sparse matrix have been named of late: their marks are greater than `last`, which only grows.
struct ColumnMarks {
  std::vector<std::uint32_t> mark;
  std::uint32_t last = 0;

  void fit(std::size_t columns) {
    constexpr std::uint32_t most = std::uint32_t(1) << 31;
    if (mark.size() < columns) mark.resize(columns, 0);
    if (last < most) return;
    std::fill(mark.begin(), mark.end(), 0);
    last = 0;
  }
};
inline std::array<ColumnMarks, 2>& thread_column_marks() {
  thread_local std::array<ColumnMarks, 2> own;
  return own;
}

inline void release_thread_scratch() {
  thread_column_marks() = {};
  thread_scratch<float>() = {};
  thread_scratch<double>() = {};
}

}  // namespace fairing
