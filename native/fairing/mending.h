// SPDX-License-Identifier: GPL-3.0-or-later
// Runs on a mended mesh for a caller who knows only the input: translates ids on the way in and
// out.
#pragma once

#include <vector>

#include "fairing/options.h"
#include "fairing/output.h"
#include "fairing/report.h"
#include "mesh/mend/mend.h"
#include "parallel/memory.h"

namespace fairing {

// Throws for defects of the arrays themselves that a run would not mend.
void require_readable(const PolygonMesh& input, Repair repair);

class Mending {
 public:
  // Mends if `options` ask for it. The arrays of `input` and the spans of `options` must outlive
  // this. May throw FairingError and bad_alloc.
  Mending(const PolygonMesh& input, const FairOptions& options);
  Mending(const Mending&) = delete;
  Mending& operator=(const Mending&) = delete;

  // The mesh to fair and its options; the given ones if nothing was mended.
  const PolygonMesh& mesh() const { return mesh_; }
  const FairOptions& options() const { return options_; }
  // Null if nothing was mended.
  const MendedMesh* mended() const { return mended_.changed() ? &mended_ : nullptr; }

  // Other positions of the input's vertices, as positions of mesh().
  std::vector<double> placed(std::span<const double> coordinates) const {
    return mended_.placed(coordinates);
  }

  // Back to the input's ids: points of a surface at merged vertices, the polygons of faces, and the
  // faces and vertices of a report.
  void restore_points(double* world) const;
  void restore(OutputFaces& faces) const;
  void restore(Report& report) const;
  // Ids of faces in the input, in order.
  std::vector<std::int64_t> faces_of_input(std::span<const std::int64_t> faces) const;

  // Runs call() and translates its errors to the input's ids.
  template <class Call>
  auto in_input_ids(Call&& call) const {
    try {
      return call();
    } catch (const FairingError& error) {
      throw restored(error);
    }
  }

 private:
  FairingError restored(const FairingError& error) const;
  void restore(std::vector<Warning>& warnings) const;
  void map_options(const PolygonMesh& input);
  void map_edges(const PolygonMesh& input);
  void map_faces(const PolygonMesh& input);
  void map_vertex_values(const PolygonMesh& input);

  MendedMesh mended_;
  CountedBytes counted_;  // mended_
  PolygonMesh mesh_;
  FairOptions options_;
  std::vector<double> shapes_;
};

}  // namespace fairing
