// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays from NumPy and to it, without copies.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <span>

#include "parallel/memory.h"

namespace fairing {

template <class T>
using Contiguous = pybind11::array_t<T, pybind11::array::c_style>;

template <class T>
std::span<const T> as_span(const Contiguous<T>& a) {
  return {a.data(), std::size_t(a.size())};
}

// Hands an Array over.
template <class T>
pybind11::array to_numpy(Array<T>&& values, pybind11::ssize_t columns) {
  auto owner = std::make_unique<Array<T>>(std::move(values));
  T* data = owner->data();
  const auto size = pybind11::ssize_t(owner->size());
  pybind11::capsule free_later(owner.release(), [](void* p) { delete static_cast<Array<T>*>(p); });
  if (columns == 1) return pybind11::array_t<T>({size}, data, free_later);
  return pybind11::array_t<T>({size / columns, columns}, data, free_later);
}

}  // namespace fairing
