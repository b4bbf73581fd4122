// SPDX-License-Identifier: GPL-3.0-or-later
// Copies arrays from NumPy, and passes large ones to NumPy without a copy.
#pragma once

#include <pybind11/numpy.h>

#include <cstring>
#include <memory>
#include <vector>

#include "mesh/polygon_mesh.h"
#include "parallel/memory.h"

namespace fairing {

template <class T>
using Contiguous = pybind11::array_t<T, pybind11::array::c_style>;
using Numbers = Contiguous<double>;
using Ids = Contiguous<std::int64_t>;

// An argument whose type the package has checked.
inline pybind11::arg exact(const char* name) { return pybind11::arg(name).noconvert(); }

// Call it with Python's lock: later writes to the caller's array do not reach a run. The array may
// be misaligned.
template <class T>
std::vector<T> copy_of(const Contiguous<T>& a) {
  std::vector<T> out(std::size_t(a.size()));
  if (!out.empty()) std::memcpy(out.data(), a.request().ptr, out.size() * sizeof(T));
  return out;
}

inline OwnedPolygonMesh copy_of(const Numbers& vertices, const Ids& corners, const Ids& offsets) {
  return {copy_of(vertices), copy_of(corners), copy_of(offsets)};
}

// Passes an Array without a copy.
template <class T>
pybind11::array to_numpy(Array<T>&& values, pybind11::ssize_t columns) {
  auto owner = std::make_unique<Array<T>>(std::move(values));
  T* data = owner->data();
  const auto size = pybind11::ssize_t(owner->size());
  pybind11::capsule free_later(owner.release(), [](void* p) { delete static_cast<Array<T>*>(p); });
  if (columns == 1) return pybind11::array_t<T>({size}, data, free_later);
  return pybind11::array_t<T>({size / columns, columns}, data, free_later);
}

// Copies a short array.
template <class T>
pybind11::array to_numpy(const std::vector<T>& values, pybind11::ssize_t columns = 1) {
  return to_numpy(Array<T>(values.begin(), values.end()), columns);
}

}  // namespace fairing
