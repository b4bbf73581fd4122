// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include <gtest/gtest.h>

namespace fairing {
namespace {

using Ids = std::vector<std::int64_t>;

TEST(Relisted, AgreesWithTheNewNumber) {
  const std::string two = "2 faces (4, 9) have no area. Dissolve or delete them.";
  EXPECT_EQ(relisted(two, ElementKind::face, Ids{3}),
            "1 face (3) has no area. Dissolve or delete them.");
  EXPECT_EQ(relisted("1 vertex (7) lies far out.", ElementKind::vertex, Ids{1, 2}),
            "2 vertices (1, 2) lie far out.");
  EXPECT_EQ(relisted("1 face (7) had no area and was dissolved.", ElementKind::face, Ids{1, 2}),
            "2 faces (1, 2) had no area and were dissolved.");
  EXPECT_EQ(relisted("2 faces (1, 2) had no area and were dissolved.", ElementKind::face, Ids{7}),
            "1 face (7) had no area and was dissolved.");
}

TEST(Relisted, NamesEdgesByPairs) {
  EXPECT_EQ(relisted("2 edges (0-4, 4-9) are shared.", ElementKind::edge, Ids{3, 8}),
            "1 edge (3-8) is shared.");
  EXPECT_EQ(relisted("1 crease (0-4) joins two", ElementKind::edge, Ids{3, 8, 8, 9}),
            "2 creases (3-8, 8-9) join two");
}

TEST(Relisted, ShowsTheFirstFive) {
  EXPECT_EQ(relisted("1 face (7) is large.", ElementKind::face, Ids{1, 2, 3, 4, 5, 6}),
            "6 faces (1, 2, 3, 4, 5, …) are large.");
}

TEST(Relisted, LeavesWhatListsNothingOrOtherElements) {
  const std::string other = "1 vertex (7) lies far out.";
  EXPECT_EQ(relisted(other, ElementKind::face, Ids{1}), other);
  EXPECT_EQ(relisted("Out of memory.", ElementKind::mesh, {}), "Out of memory.");
}

}  // namespace
}  // namespace fairing
