// SPDX-License-Identifier: GPL-3.0-or-later
// A block of rows of a sparse matrix. What a large matrix costs is reading it: rows name their columns by short places
// among those of the block, and rows alike, as there are many along an edge and inside a face, share their numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fairing {

constexpr std::size_t chunk_rows = 256;
constexpr std::uint32_t row_block = 4;

struct RowChunk {
  using Place = std::uint16_t;
  struct Row {
    std::uint32_t end;     // of its places; a zero row has none
    std::uint32_t number;  // the first of as many
  };
  std::vector<std::uint32_t> column;  // of the block, each once
  std::vector<Row> row;
  std::vector<Place> place;   // rows are filled up to whole blocks
  std::vector<float> number;  // with zeros

  void clear() {
    column.clear();
    row.clear();
    place.clear();
    number.clear();
  }
  std::size_t bytes() const {
    return column.capacity() * sizeof(std::uint32_t) + row.capacity() * sizeof(Row) +
           place.capacity() * sizeof(Place) + number.capacity() * sizeof(float);
  }
};

// image <- a chunk's rows of the matrix times x, with C numbers a point, 1 or 3, and up to one number beyond. Every number
// sees the same operations in the same order on all machines. x has `vector_room` more.
template <int C>
void chunk_image(const RowChunk& chunk, const float* x, float* image);

}  // namespace fairing
