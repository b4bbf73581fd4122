// SPDX-License-Identifier: GPL-3.0-or-later
// Buffers of the calling thread, kept from call to call: to get and clear large ones anew in every pass costs as much as the
// pass. They go with the thread; the one that owns the Workers gives its own back with them.
#pragma once

#include <cstddef>
#include <vector>

namespace fairing {

template <class T>
struct ThreadScratch {
  std::vector<T> closed;    // accumulate()'s: a closed face
  std::vector<T> run;       // an edge's points
  std::vector<T> work;      // what a body works in
  std::vector<T> gathered;  // closed faces that a body reads
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

inline void release_thread_scratch() {
  thread_scratch<float>() = {};
  thread_scratch<double>() = {};
}

}  // namespace fairing
