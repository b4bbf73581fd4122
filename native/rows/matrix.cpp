// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows/matrix.h"

namespace fairing {
namespace {

constexpr std::size_t grain = 16;  // chunks worth a thread

struct RowsJob {
  const RowChunk* chunk;
  const float* x;
  float* image;
};

template <int C>
struct RowsLoop {
  template <class T, int Bytes>
  struct Of {
    DF_INLINE static void run(const RowsJob* job) {
      const RowChunk& chunk = *job->chunk;
      const std::uint32_t* row_end = chunk.row_end.data();
      std::uint32_t k = 0;
      float* image = job->image;
      for (const ChunkRun& run : chunk.runs)
        for (Index i = 0; i < run.count; ++i, image += C) {
          if (run.kind == ChunkRun::zero) {
            for (int a = 0; a < C; ++a) image[a] = 0;
            continue;
          }
          WrittenRow<C>::run(chunk.column.data(), chunk.number.data(), k, *row_end, job->x, image);
          k = *row_end++;
        }
    }
  };
};

}  // namespace

template <class Visit>
static void visit_entries(const Array<RowChunk>& chunks, Visit&& visit) {
  Index row = 0;
  for (const RowChunk& chunk : chunks) {
    const std::uint32_t* row_end = chunk.row_end.data();
    std::uint32_t k = 0;
    for (const ChunkRun& run : chunk.runs)
      for (Index i = 0; i < run.count; ++i, ++row) {
        if (run.kind == ChunkRun::zero) continue;
        for (; k < *row_end; ++k)
          if (chunk.number[k] != 0) visit(row, std::size_t(chunk.column[k]), chunk.number[k]);
        ++row_end;
      }
  }
}

WrittenMatrix::Columns WrittenMatrix::by_columns() const {
  Columns out;
  out.first.assign(columns_ + 1, 0);
  visit_entries(chunk_, [&](Index, std::size_t column, float) { ++out.first[column + 1]; });
  for (std::size_t c = 0; c < columns_; ++c) out.first[c + 1] += out.first[c];
  out.entry.resize(out.first.back());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  visit_entries(chunk_, [&](Index row, std::size_t column, float number) {
    out.entry[next[column]++] = {row, number};
  });
  return out;
}

template <int C>
void WrittenMatrix::apply(const float* x, Workers& workers, float* y) const {
  workers.for_parts(chunk_.size(), grain, [&](std::size_t begin, std::size_t end) {
    alignas(64) float image[C * chunk_points + 4];
    for (std::size_t c = begin; c < end; ++c) {
      const RowsJob job{&chunk_[c], x, image};
      run_loop<RowsLoop<C>::template Of, float>(&job);
      const std::size_t first = c * chunk_points;
      std::copy_n(image, C * std::min(chunk_points, rows_ - first), y + C * first);
    }
  });
}

template void WrittenMatrix::apply<1>(const float*, Workers&, float*) const;
template void WrittenMatrix::apply<3>(const float*, Workers&, float*) const;

}  // namespace fairing
