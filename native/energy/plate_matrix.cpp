// SPDX-License-Identifier: GPL-3.0-or-later
#include "energy/plate_matrix.h"

#include <cstdlib>
#include <memory>

#include "lattice/ring.h"
#include "rows/builder.h"
#include "solver/chebyshev.h"

namespace fairing {
namespace {

constexpr std::size_t most_rows = std::size_t(1) << 22;  // written on a level
constexpr std::size_t most_products = 128;               // a point's rings by their sizes
constexpr std::size_t grain = 8;                         // chunks worth a thread
constexpr std::size_t usual_row = 20;
constexpr int deep = 3;  // steps from all sides, from where on a row has nothing but its face's own points

std::size_t deep_points(bool quad, int n) {
  const int inner = n - (quad ? 2 : 3) * (deep - 1);
  return inner > 1 ? std::size_t(interior_size(quad, inner)) : 0;
}

}  // namespace

bool PlateMatrix::suits(const Lattice& lattice, const Stencils& stencils) {
  const ControlMesh& mesh = lattice.mesh();
  std::size_t rows = lattice.size(), products = 81 * lattice.size();
  for (const Face& face : mesh.faces) rows -= deep_points(face.quad(), lattice.n());
  for (std::size_t v = 0; v + 1 < stencils.ring_offset.size(); ++v) {
    const auto size = std::size_t(stencils.ring_offset[v + 1] - stencils.ring_offset[v]);
    products += size * size;
  }
  return rows <= most_rows && products < most_products * lattice.size();
}

PlateMatrix::PlateMatrix(const Lattice& lattice, const ThinPlateRows<float>& rows, const Unknowns& unknowns,
                         Workers& workers)
    : lattice_(lattice) {
  cut_into_runs(unknowns);
  write_rows(PlateRings(lattice, rows.stencils, unknowns, deep, workers), workers);
  write_stencils(rows);
  for (const RowChunk& chunk : chunk_) bytes_ += chunk.bytes();
  MemoryLedger::add(bytes_);
}

PlateMatrix::~PlateMatrix() { MemoryLedger::remove(bytes_); }

void PlateMatrix::cut_into_runs(const Unknowns& unknowns) {
  const ControlMesh& mesh = lattice_.mesh();
  const int n = lattice_.n();
  const JointWeight joint(lattice_);
  chunk_.resize((lattice_.size() + chunk_points - 1) / chunk_points);
  std::size_t p = 0;
  const auto put = [&](ChunkRun::Kind kind, std::int64_t count, Index face = 0, Index row = 0) {
    while (count > 0) {
      std::vector<ChunkRun>& runs = chunk_[p / chunk_points].runs;
      const auto part = std::min(count, std::int64_t(chunk_points - p % chunk_points));
      if (!runs.empty() && runs.back().kind == kind && kind <= ChunkRun::written)
        runs.back().count += Index(part);
      else
        runs.push_back({kind, Index(part), face, row});
      p += std::size_t(part);
      count -= part;
    }
  };
  const auto kind = [](bool unknown) { return unknown ? ChunkRun::written : ChunkRun::zero; };
  for (Index v = 0; v < mesh.vertex_count(); ++v) put(kind(unknowns.vertex[std::size_t(v)]), 1);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) put(kind(unknowns.edge[e]), n - 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const bool quad = mesh.faces[f].quad();
    if (!unknowns.has_face(f) || deep_points(quad, n) == 0 || joint.weighs_face(Index(f))) {
      put(kind(unknowns.has_face(f)), interior_size(quad, n));
      continue;
    }
    for (int j = 1; j < n; ++j) {
      const int width = quad ? n - 1 : n - 1 - j;
      const int inner = width - 2 * (deep - 1);
      if (j < deep || n - j < deep || inner <= 0) {
        put(ChunkRun::written, width);
        continue;
      }
      put(ChunkRun::written, deep - 1);
      put(quad ? ChunkRun::quad : ChunkRun::triangle, inner, Index(f), j);
      put(ChunkRun::written, deep - 1);
    }
  }
}

namespace {

// Row p of K, from the rings that hold the point: they are those about its own ring's members.
void write_row(const PlateRings& plate, Index p, RowBuilder& row, RowChunk& chunk) {
  const WrittenRings& rings = plate.rings();
  row.add(p, 0);  // the diagonal comes first
  const WrittenRings::Ring& own = *rings.about(p);
  for (std::size_t k = 0; k < own.size; ++k) {
    const WrittenRings::Ring* ring = plate.fit_about(WrittenRings::id_of(rings.members(own)[k]));
    const std::size_t slot = ring ? rings.slot(*ring, p) : 0;
    if (!ring || slot == ring->size) continue;
    const WrittenRings::Member* members = rings.members(*ring);
    const double* numbers = plate.row(*ring, slot);
    const double weight = plate.weight(*ring);
    for (std::size_t m = 0; m < ring->size; ++m)
      if (members[m] >= 0) row.add(members[m], weight * numbers[m]);
  }
  row.finish(chunk);
}

}  // namespace

void PlateMatrix::write_rows(const PlateRings& rings, Workers& workers) {
  workers.for_parts(chunk_.size(), 4, [&](std::size_t begin, std::size_t end) {
    RowBuilder row(lattice_.size());
    for (std::size_t c = begin; c < end; ++c) {
      RowChunk& chunk = chunk_[c];
      std::size_t written = 0;
      for (const ChunkRun& run : chunk.runs)
        written += run.kind == ChunkRun::written ? std::size_t(run.count) : 0;
      chunk.row_end.reserve(written);
      chunk.column.reserve(usual_row * written);
      chunk.number.reserve(usual_row * written);
      auto p = Index(c * chunk_points);
      for (const ChunkRun& run : chunk.runs) {
        if (run.kind == ChunkRun::written)
          for (Index i = 0; i < run.count; ++i) write_row(rings, p + i, row, chunk);
        p += run.count;
      }
    }
  });
  unweighted_.resize(std::size_t(lattice_.mesh().vertex_count()));
  for (std::size_t c = 0; c * chunk_points < unweighted_.size(); ++c)
    visit_written(chunk_[c], Index(c * chunk_points), [&](Index p, const float* first, const float*) {
      if (std::size_t(p) < unweighted_.size()) unweighted_[std::size_t(p)] = *first;
    });
}

template <class Chunk, class Visit>
void PlateMatrix::visit_written(Chunk& chunk, Index point, Visit&& visit) {
  std::uint32_t first = 0;
  const std::uint32_t* end = chunk.row_end.data();
  for (const ChunkRun& run : chunk.runs) {
    if (run.kind == ChunkRun::written)
      for (Index i = 0; i < run.count; ++i) {
        visit(point + i, chunk.number.data() + first, chunk.number.data() + *end);
        first = *end++;
      }
    point += run.count;
  }
}

void PlateMatrix::set_weights(const VertexWeights& weights) {
  for (std::size_t c = 0; c * chunk_points < weights.size(); ++c)
    visit_written(chunk_[c], Index(c * chunk_points), [&](Index p, float* first, float*) {
      if (const auto v = std::size_t(p); v < weights.size()) *first = unweighted_[v] + float(weights[v]);
    });
}

void PlateMatrix::write_stencils(const ThinPlateRows<float>& rows) {
  const ControlMesh& mesh = lattice_.mesh();
  const auto scale = double(lattice_.n()) * lattice_.n();
  stencil_.resize(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const bool quad = mesh.faces[f].quad();
    // The second differences' own stencils, one applied after the other, on the places (-2 … 2)^2.
    double sum[5][5] = {};
    const std::span<const LatticePoint> step = face_ring(quad);
    const std::size_t directions = step.size() / 2;
    const double* g = rows.stencils.face_energy.data() + 12 * f;
    for (std::size_t a = 0; a < directions; ++a)
      for (std::size_t b = 0; b < directions; ++b) {
        const double c = scale * (g[a] * g[b] + g[4 + a] * g[4 + b] + g[8 + a] * g[8 + b]);
        for (int k = -1; k <= 1; ++k)
          for (int m = -1; m <= 1; ++m)
            sum[2 + k * step[a].j + m * step[b].j][2 + k * step[a].i + m * step[b].i] +=
                (k == 0 ? -2 : 1) * (m == 0 ? -2 : 1) * c;
      }
    const StencilPlaces& places = quad ? quad_places : triangle_places;
    stencil_[f].centre = float(sum[2][2]);
    for (int k = 0; k < places.count; ++k)
      stencil_[f].pair[k] = float(sum[2 + places.at[k].j][2 + places.at[k].i]);
  }
}

Array<float> PlateMatrix::inverse_diagonal() const {
  Array<float> inverse(lattice_.size(), 1.0f);
  for (std::size_t c = 0; c < chunk_.size(); ++c) {
    auto p = Index(c * chunk_points);
    visit_written(chunk_[c], p,
                  [&](Index q, const float* first, const float*) { inverse[std::size_t(q)] = 1 / *first; });
    for (const ChunkRun& run : chunk_[c].runs) {
      if (run.kind > ChunkRun::written)
        std::fill_n(inverse.begin() + p, run.count, 1 / stencil_[std::size_t(run.face)].centre);
      p += run.count;
    }
  }
  return inverse;
}

namespace {

struct ChunkJob {
  const RowChunk* chunk;
  const FaceStencil* stencils;
  int n;
  std::size_t point;
  const float* x;
  float* image;
};

template <class T, int Bytes>
struct ChunkLoop {
  DF_INLINE static void run(const ChunkJob* job) {
    ChunkImage<Bytes>::run(*job->chunk, job->stencils, job->n, job->point, job->x, job->image);
  }
};

}  // namespace

// Calls finish(point, count, image) for every chunk.
template <class Finish>
void PlateMatrix::visit_images(const float* x, Workers& workers, const Finish& finish) const {
  workers.for_parts(chunk_.size(), grain, [&](std::size_t begin, std::size_t end) {
    alignas(64) float image[3 * chunk_points + vector_room];
    for (std::size_t c = begin; c < end; ++c) {
      const ChunkJob job{&chunk_[c], stencil_.data(), lattice_.n(), c * chunk_points, x, image};
      run_loop<ChunkLoop, float>(&job);
      finish(job.point, std::min(chunk_points, lattice_.size() - job.point), image);
    }
  });
}

void PlateMatrix::apply(const float* x, Workers& workers, float* y) const {
  visit_images(x, workers, [=](std::size_t p, std::size_t count, const float* image) {
    std::copy_n(image, 3 * count, y + 3 * p);
  });
}

void PlateMatrix::subtract_image(const float* x, Workers& workers, float* y) const {
  visit_images(x, workers, [=](std::size_t p, std::size_t count, const float* image) {
    for (std::size_t i = 0; i < 3 * count; ++i) y[3 * p + i] -= image[i];
  });
}

void PlateMatrix::relax(const SmoothingStep& step, const float* inverse_diagonal, Workers& workers) const {
  visit_images(step.d, workers, [&](std::size_t p, std::size_t count, const float* image) {
    finish_step(step, 3, inverse_diagonal, p, count, image);
  });
}

}  // namespace fairing
