// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows/matrix.h"

namespace fairing {
namespace {

template <int C>
struct RowsLoop {
  template <class T, int Bytes>
  struct Of {
    DF_INLINE static void run(const RowChunk* chunk, const float* x, float* image) {
      std::uint32_t k = 0;
      for (const std::uint32_t end : chunk->row_end) {
        RowSum<C>::run(chunk->column.data(), chunk->number.data(), k, end, x, image);
        k = end;
        image += C;
      }
    }
  };
};

template <class Visit>
void visit_numbers(const Array<RowChunk>& chunks, Visit&& visit) {
  Index row = 0;
  for (const RowChunk& chunk : chunks) {
    std::uint32_t k = 0;
    for (const std::uint32_t end : chunk.row_end) {
      for (; k < end; ++k)
        if (chunk.number[k] != 0) visit(row, std::size_t(chunk.column[k]), chunk.number[k]);
      ++row;
    }
  }
}

}  // namespace

template <int C>
void chunk_image(const RowChunk& chunk, const float* x, float* image) {
  run_loop<RowsLoop<C>::template Of, float>(&chunk, x, image);
}
template void chunk_image<1>(const RowChunk&, const float*, float*);
template void chunk_image<3>(const RowChunk&, const float*, float*);

WrittenMatrix::Columns WrittenMatrix::by_columns() const {
  Columns out;
  out.first.assign(columns_ + 1, 0);
  visit_numbers(chunk_, [&](Index, std::size_t column, float) { ++out.first[column + 1]; });
  for (std::size_t c = 0; c < columns_; ++c) out.first[c + 1] += out.first[c];
  out.entry.resize(out.first.back());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  visit_numbers(chunk_, [&](Index row, std::size_t column, float number) {
    out.entry[next[column]++] = {row, number};
  });
  return out;
}

}  // namespace fairing
