#include "vmesh/core/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "vmesh/core/changing_box_tree.h"

#include "draw.h"

namespace vmesh {
namespace {

using testing::Draw;

struct Boxes {
  std::vector<Vec3> low, high;
};

Boxes random_boxes(Draw& draw, Index count, double size) {
  Boxes boxes;
  for (Index i = 0; i < count; ++i) {
    boxes.low.push_back(draw.in_cube(10));
    boxes.high.push_back(boxes.low.back() + Vec3(draw.uniform(0, size), draw.uniform(0, size), draw.uniform(0, size)));
  }
  return boxes;
}

double distance(const Boxes& boxes, Index i, const Vec3& p) {
  return (boxes.low[i] - p).cwiseMax(p - boxes.high[i]).cwiseMax(0).norm();
}

std::vector<Index> overlapping(const BoxTree& tree, const Vec3& low, const Vec3& high) {
  std::vector<Index> found;
  tree.visit_overlapping(low, high, [&](Index i) { found.push_back(i); });
  std::sort(found.begin(), found.end());
  return found;
}

// The tree hands out whole leaves: what it must not do is leave out an item, or hand out one twice.
void expect_all_overlapping(const Boxes& boxes, const BoxTree& tree, const Vec3& low, const Vec3& high) {
  const auto found = overlapping(tree, low, high);
  EXPECT_TRUE(std::adjacent_find(found.begin(), found.end()) == found.end());
  for (Index i = 0; i < boxes.low.size(); ++i) {
    const bool meets = (boxes.low[i].array() <= high.array()).all() && (boxes.high[i].array() >= low.array()).all();
    if (meets) {
      EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i)) << i;
    }
  }
}

TEST(BoxTree, FindsTheMinimum) {
  Draw draw(21);
  for (const Index count : {1u, 2u, 4u, 5u, 9u, 64u, 1000u}) {
    const Boxes boxes = random_boxes(draw, count, 1);
    const BoxTree tree(boxes.low, boxes.high);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = draw.in_cube(15);
      double expected = std::numeric_limits<double>::infinity(), limit = expected;
      for (Index item = 0; item < count; ++item) expected = std::min(expected, distance(boxes, item, p));
      tree.visit(p, limit, [&](Index item) { limit = std::min(limit, distance(boxes, item, p)); });
      EXPECT_EQ(limit, expected);
    }
  }
}

TEST(BoxTree, FindsTheMinimumWithoutLookingAtEverything) {
  Draw draw(22);
  const Index count = 4096;
  const Boxes boxes = random_boxes(draw, count, 0.1);
  const BoxTree tree(boxes.low, boxes.high);
  int visited = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = draw.in_cube(10);
    double limit = std::numeric_limits<double>::infinity();
    tree.visit(p, limit, [&](Index item) {
      ++visited;
      limit = std::min(limit, distance(boxes, item, p));
    });
  }
  // About 20 leaves of 4 touch the ball up to the closest of uniformly spread items; a sixth of all is far beyond that.
  EXPECT_LT(visited / 100, static_cast<int>(count / 6));
}

TEST(BoxTree, VisitsEveryItemWithinTheLimitOnce) {
  Draw draw(23);
  const Boxes boxes = random_boxes(draw, 500, 2);
  const BoxTree tree(boxes.low, boxes.high);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = draw.in_cube(12);
    const double limit = draw.uniform(0, 4);
    std::vector<int> visits(500, 0);
    tree.visit(p, limit, [&](Index item) { ++visits[item]; });
    for (Index item = 0; item < 500; ++item) {
      EXPECT_LE(visits[item], 1);
      if (distance(boxes, item, p) <= limit) {
        EXPECT_EQ(visits[item], 1);
      }
    }
  }
}

TEST(BoxTree, DoesNotMissWhatIsDeepestInside) {
  // Nested cubes around the origin, the deepest sphere in the largest one: a signed distance below zero.
  Boxes boxes;
  for (int i = 1; i <= 50; ++i) {
    boxes.low.push_back(Vec3::Constant(-i));
    boxes.high.push_back(Vec3::Constant(i));
  }
  const BoxTree tree(boxes.low, boxes.high);
  Draw draw(24);
  for (int i = 0; i < 50; ++i) {
    const Vec3 p = draw.in_cube(1);
    double limit = std::numeric_limits<double>::infinity();
    tree.visit(p, limit, [&](Index item) { limit = std::min(limit, p.norm() - (item + 1)); });
    EXPECT_EQ(limit, p.norm() - 50);
  }
}

TEST(BoxTree, VisitsAllOverlappingItems) {
  Draw draw(25);
  for (const Index count : {1u, 2u, 5u, 300u}) {
    const Boxes boxes = random_boxes(draw, count, 3);
    const BoxTree tree(boxes.low, boxes.high);
    for (int i = 0; i < 100; ++i) {
      const Vec3 low = draw.in_cube(10);
      expect_all_overlapping(boxes, tree, low, low + Vec3(draw.uniform(0, 8), draw.uniform(0, 8), draw.uniform(0, 8)));
      expect_all_overlapping(boxes, tree, low, low);  // a point
    }
  }
}

TEST(BoxTree, FindsAnyOverlappingItemThatIsSought) {
  Draw draw(28);
  for (const Index count : {0u, 1u, 5u, 300u}) {
    const Boxes boxes = random_boxes(draw, count, 3);
    const BoxTree tree(boxes.low, boxes.high);
    for (int i = 0; i < 200; ++i) {
      const Vec3 low = draw.in_cube(10), high = low + Vec3::Constant(draw.uniform(0, 4));
      const Index divisor = 1 + draw.below(20);
      const auto is_sought = [&](Index item) {
        return item % divisor == 0 && (boxes.low[item].array() <= high.array()).all() &&
               (boxes.high[item].array() >= low.array()).all();
      };
      bool expected = false;
      for (Index item = 0; item < count; ++item) expected = expected || is_sought(item);
      bool last = false;
      EXPECT_EQ(tree.any_overlapping(low, high,
                                     [&](Index item) {
                                       EXPECT_FALSE(last) << "called after it held";
                                       return last = is_sought(item);
                                     }),
                expected);
    }
  }
}

TEST(BoxTree, VisitsEveryPairThatMeetsOnce) {
  Draw draw(26);
  for (const Index count : {1u, 2u, 4u, 5u, 9u, 300u}) {
    const Boxes boxes = random_boxes(draw, count, 3);
    std::set<std::pair<Index, Index>> visited;
    BoxTree(boxes.low, boxes.high).visit_pairs([&](Index i, Index j) {
      EXPECT_TRUE(visited.insert(std::minmax(i, j)).second) << i << " " << j;
      EXPECT_NE(i, j);
    });
    for (Index i = 0; i < count; ++i) {
      for (Index j = i + 1; j < count; ++j) {
        const bool meet = (boxes.low[i].array() <= boxes.high[j].array()).all() &&
                          (boxes.low[j].array() <= boxes.high[i].array()).all();
        if (meet) {
          EXPECT_TRUE(visited.contains({i, j})) << i << " " << j;
        }
      }
    }
    if (count == 300) {  // few of those that do not meet
      EXPECT_LT(visited.size(), 300u * 299u / 4);
    }
  }
}

TEST(BoxTree, CountsBoxesThatOnlyTouchAsOverlapping) {
  const BoxTree tree({{0, 0, 0}}, {{1, 1, 1}});
  EXPECT_EQ(overlapping(tree, {1, 1, 1}, {2, 2, 2}), (std::vector<Index>{0}));
  EXPECT_EQ(overlapping(tree, {-1, -1, -1}, {0, 0, 0}), (std::vector<Index>{0}));
  EXPECT_TRUE(overlapping(tree, {1, 1, std::nextafter(1.0, 2.0)}, {2, 2, 2}).empty());
  EXPECT_TRUE(overlapping(tree, {-1, 0, 0}, {std::nextafter(0.0, -1.0), 1, 1}).empty());
}

TEST(BoxTree, KeepsDuplicatesApart) {
  const BoxTree tree(std::vector<Vec3>(100, Vec3(1, 2, 3)), std::vector<Vec3>(100, Vec3(2, 3, 4)));
  const auto found = overlapping(tree, {1, 2, 3}, {1, 2, 3});
  ASSERT_EQ(found.size(), 100u);
  for (Index i = 0; i < 100; ++i) EXPECT_EQ(found[i], i);
}

TEST(BoxTree, VisitsNothingWhenEmpty) {
  const double limit = std::numeric_limits<double>::infinity();
  for (const BoxTree& tree : {BoxTree(), BoxTree({}, {})}) {
    tree.visit({0, 0, 0}, limit, [](Index) { FAIL(); });
    EXPECT_TRUE(overlapping(tree, {-1, -1, -1}, {1, 1, 1}).empty());
    tree.visit_pairs([](Index, Index) { FAIL(); });
  }
}

std::vector<Index> overlapping(const ChangingBoxTree& tree, const BoxTree::Box& box) {
  std::vector<Index> found;
  std::size_t visited = 0;
  tree.any_overlapping(box.low, box.high, visited, [&](Index i, const BoxTree::Box& its_box) {
    EXPECT_EQ(its_box.low, tree.box(i).low);
    EXPECT_EQ(its_box.high, tree.box(i).high);
    found.push_back(i);
    return false;
  });
  EXPECT_GE(visited, found.size());
  std::sort(found.begin(), found.end());
  return found;
}

BoxTree::Box random_box(Draw& draw, double size) {
  const Vec3 low = draw.in_cube(10);
  return {low, low + Vec3(draw.uniform(0, size), draw.uniform(0, size), draw.uniform(0, size))};
}

// Boxes of every second number from the start; then some move, near or far, and others are added.
TEST(ChangingBoxTree, FindsExactlyWhatOverlapsWhileBoxesChange) {
  Draw draw(27);
  for (const Index count : {0u, 1u, 2u, 3u, 400u}) {
    std::vector<std::optional<BoxTree::Box>> boxes(2 * count + 300);
    std::vector<ChangingBoxTree::Item> items;
    for (Index i = 0; i < count; ++i) {
      boxes[2 * i] = random_box(draw, 3);
      items.push_back({2 * i, *boxes[2 * i]});
    }
    ChangingBoxTree tree(items);
    EXPECT_EQ(tree.size(), count);
    for (std::size_t change = 0; change < 1000; ++change) {
      const Index item = draw.below(static_cast<Index>(boxes.size()));
      EXPECT_EQ(tree.has(item), boxes[item].has_value());
      if (boxes[item] && draw.chance(0.7)) {
        const Vec3 way = draw.uniform(0, 0.5) * draw.direction();
        boxes[item] = {boxes[item]->low + way, boxes[item]->high + way};
      } else {
        boxes[item] = random_box(draw, 3);
      }
      tree.set(item, *boxes[item]);
      EXPECT_EQ(tree.box(item).low, boxes[item]->low);
      EXPECT_EQ(tree.box(item).high, boxes[item]->high);
      const BoxTree::Box sought = random_box(draw, change % 2 == 0 ? 0 : 5);
      std::vector<Index> expected;
      for (Index i = 0; i < boxes.size(); ++i) {
        if (boxes[i] && boxes[i]->overlaps(sought.low, sought.high)) expected.push_back(i);
      }
      EXPECT_EQ(overlapping(tree, sought), expected);
    }
    EXPECT_EQ(tree.size(), static_cast<std::size_t>(std::count_if(boxes.begin(), boxes.end(),
                                                                  [](const auto& box) { return box.has_value(); })));
  }
}

// Boxes that touch or just do not, at coordinates that single precision can and cannot hold.
TEST(ChangingBoxTree, TellsBoxesThatTouchFromThoseThatDoNot) {
  for (const double at : {0.0, 1.0, 0.1, 1.0 / 3, 12345.678901, 1e-30, 1e-42, 1e300}) {
    for (const double x : {at, -at}) {
      const double below = std::nextafter(x, -std::numeric_limits<double>::infinity());
      const double above = std::nextafter(x, std::numeric_limits<double>::infinity());
      const auto box = [](double from, double to) { return BoxTree::Box{{from, 0, 0}, {to, 1, 1}}; };
      const double left = x - 1 - std::abs(x), right = x + 1 + std::abs(x);
      ChangingBoxTree tree({{0, box(left, x)}, {1, box(x, right)}});
      tree.set(2, box(left, below));
      tree.set(3, box(above, right));
      EXPECT_EQ(overlapping(tree, box(x, x)), (std::vector<Index>{0, 1})) << x;
      EXPECT_EQ(overlapping(tree, box(below, below)), (std::vector<Index>{0, 2})) << x;
      EXPECT_EQ(overlapping(tree, box(above, above)), (std::vector<Index>{1, 3})) << x;
    }
  }
}

TEST(ChangingBoxTree, LooksNoFurtherThanTheFirstItemThatIsSought) {
  const BoxTree::Box box{Vec3::Zero(), Vec3::Ones()};
  const ChangingBoxTree tree({{0, box}, {1, box}, {2, box}});
  int looked = 0;
  std::size_t visited = 0;
  const auto first = [&](Index, const BoxTree::Box&) { return ++looked == 2; };
  EXPECT_TRUE(tree.any_overlapping(box.low, box.high, visited, first));
  EXPECT_EQ(looked, 2);
  EXPECT_LE(visited, 5u);
  EXPECT_FALSE(tree.any_overlapping(Vec3::Constant(2), Vec3::Constant(3), visited, first));
  EXPECT_EQ(looked, 2);
}

}  // namespace
}  // namespace vmesh
