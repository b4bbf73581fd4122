// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include <gtest/gtest.h>

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

TEST(Message, AgreesWithItsElementsAndNamesTheFirstFive) {
  const Message message("{face} {has|have} no area.", "Dissolve or delete {it|them}.");
  const auto of_faces = [&](const Ids& ids) { return text(message, ElementKind::face, ids); };
  EXPECT_EQ(of_faces({3}), "1 face (3) has no area. Dissolve or delete it.");
  EXPECT_EQ(of_faces({4, 9}), "2 faces (4, 9) have no area. Dissolve or delete them.");
  EXPECT_EQ(of_faces({1, 2, 3, 4, 5, 6}),
            "6 faces (1, 2, 3, 4, 5, …) have no area. Dissolve or delete them.");
  EXPECT_EQ(text(Message("{crease} {joins|join} two."), ElementKind::edge, Ids{3, 8, 8, 9}),
            "2 creases (3-8, 8-9) join two.");
  const FairingError of_double(ErrorCode::degenerate_face, message, {1, 9});
  EXPECT_STREQ(of_double.what(), of_faces({1, 9}).c_str());
  const FairingError of_half(of_double.code, of_double.message, {1}, of_double.kind);
  EXPECT_STREQ(of_half.what(), of_faces({1}).c_str());
}

TEST(Message, LeavesBracesThatAreNoPlaces) {
  EXPECT_EQ(text(Message("region is {3, 4}; {vertex} {is|are} out."), ElementKind::vertex, Ids{7}),
            "region is {3, 4}; 1 vertex (7) is out.");
  EXPECT_EQ(text(Message("{a|b} {"), ElementKind::mesh, {}), "{a|b} {");
  EXPECT_EQ(text(Message("open {"), ElementKind::vertex, Ids{7}), "open {");
}

}  // namespace
}  // namespace fairing
