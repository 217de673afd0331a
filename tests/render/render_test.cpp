#include "vmesh/render/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "vmesh/core/error.h"

#include "render/legend.h"
#include "shapes.h"

namespace vmesh {
namespace {

using testing::append;
using testing::make_sphere;
using testing::make_square;
using testing::turned_inside_out;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

RenderOptions small() {
  RenderOptions options;
  options.width = 160;
  options.height = 120;
  return options;
}

Color center_of(const Image& image) { return image.at(image.width / 2, image.height / 2); }
bool is_red(const Color& c) { return c[0] > 90 && c[0] > 2 * c[1] && c[0] > 2 * c[2]; }
bool is_magenta(const Color& c) { return c[0] > 90 && c[2] > 90 && c[0] > 2 * c[1] && c[2] > 2 * c[1]; }
bool is_grey(const Color& c) { return std::abs(c[0] - c[1]) < 8 && std::abs(c[1] - c[2]) < 8; }
bool is_yellow(const Color& c) { return c[0] > 150 && c[1] > 150 && c[2] < 100; }
bool is_dark_violet(const Color& c) { return c[2] > c[1] + 30 && c[0] > c[1] && c[1] < 60; }

std::size_t different_pixels(const Image& a, const Image& b, int from_column = 0) {
  std::size_t count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = from_column; x < a.width; ++x) count += a.at(x, y) != b.at(x, y);
  }
  return count;
}

TEST(Render, ShowsAShadedSphereOnTheBackground) {
  const Image image = render(make_sphere(5), small());
  ASSERT_EQ(image.width, 160);
  ASSERT_EQ(image.height, 120);
  ASSERT_EQ(image.pixels.size(), 160u * 120u);
  EXPECT_TRUE(is_red(center_of(image)));
  for (const int x : {0, 159}) {
    for (const int y : {0, 119}) EXPECT_EQ(image.at(x, y), RenderOptions().background);
  }
  // The light comes from above left.
  EXPECT_GT(image.at(70, 45)[0], image.at(90, 80)[0] + 20);
}

TEST(Render, FitsTheMeshIntoThePicture) {
  const Image image = render(make_sphere(5, {100, -200, 300}), small());
  const auto background = RenderOptions().background;
  EXPECT_EQ(image.at(80, 4), background);
  EXPECT_NE(image.at(80, 12), background);
  EXPECT_EQ(image.at(80, 115), background);
  EXPECT_NE(image.at(80, 107), background);
}

TEST(Render, AntiAliasesOutlines) {
  const Image image = render(make_sphere(5), small());
  const auto background = RenderOptions().background;
  bool mixed = false;  // more green than the sphere has, less than the background
  for (int x = 0; x < 80; ++x) {
    const Color c = image.at(x, 60);
    mixed = mixed || (c[1] > 110 && c[1] < background[1] - 10);
  }
  EXPECT_TRUE(mixed);
}

TEST(Render, ShowsTheInsideInMagenta) {
  const TriMesh inverted = turned_inside_out(make_sphere(5));
  EXPECT_TRUE(is_magenta(center_of(render(inverted, small()))));
  RenderOptions plain = small();
  plain.highlight_back_faces = false;
  EXPECT_TRUE(is_red(center_of(render(inverted, plain))));
}

TEST(Render, ShowsHolesAsWhatIsBehindThem) {
  TriMesh sphere = make_sphere(5);
  std::erase_if(sphere.faces, [&](const Triangle& face) { return sphere.vertices[face[0]].y() < -4; });
  EXPECT_TRUE(is_magenta(center_of(render(sphere, small()))));
}

TEST(Render, LooksFromEverySideAsAnatomistsSayIt) {
  // A small ball on each axis: +x is the patient's left, +y the back, +z the head.
  TriMesh mesh;
  const Vec3 places[] = {{10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  MeshAttribute label{"label", {}, true};
  for (int i = 0; i < 3; ++i) {
    const TriMesh ball = make_sphere(2, places[i], 16);
    append(mesh, ball);
    label.values.insert(label.values.end(), ball.vertices.size(), i);
  }
  RenderOptions options = small();
  options.legend = false;
  options.look_at = Vec3::Zero();
  options.view_height_mm = 30;  // 4 pixels per mm
  const auto at = [&](const char* view, int x, int y) {
    options.view = view_direction(view);
    return render(mesh, label, AttributeDomain::vertex, options).at(80 + 4 * x, 60 - 4 * y);
  };
  EXPECT_TRUE(is_dark_violet(at("front", 10, 0)));
  EXPECT_TRUE(is_yellow(at("front", 0, 10)));
  EXPECT_TRUE(is_dark_violet(at("back", -10, 0)));
  EXPECT_TRUE(is_yellow(at("back", 0, 10)));
  EXPECT_TRUE(is_yellow(at("left", 0, 10)));
  EXPECT_TRUE(is_dark_violet(at("left", 0, 0)));
  EXPECT_EQ(at("left", -10, 0), options.background);
  EXPECT_NE(at("left", 10, 0), options.background);
  EXPECT_NE(at("right", -10, 0), options.background);
  EXPECT_TRUE(is_yellow(at("top", 0, 0)));
  EXPECT_TRUE(is_dark_violet(at("top", 10, 0)));
  EXPECT_NE(at("top", 0, 10), options.background);
  EXPECT_NE(at("bottom", 0, -10), options.background);
}

TEST(Render, ZoomsAndLooksAtAPoint) {
  TriMesh mesh = make_sphere(1, {-10, 0, 0});
  append(mesh, make_sphere(1, {10, 0, 0}));
  EXPECT_EQ(center_of(render(mesh, small())), RenderOptions().background);
  RenderOptions close = small();
  close.look_at = Vec3(10, 0, 0);
  EXPECT_TRUE(is_red(center_of(render(mesh, close))));
  close.zoom = 40;
  const Image image = render(mesh, close);
  EXPECT_TRUE(is_red(image.at(1, 1)) || is_red(image.at(80, 1)));
}

TEST(Render, DrawsPerspectivePictures) {
  TriMesh mesh = make_sphere(1, {-5, -10, 0});
  append(mesh, make_sphere(1, {5, 10, 0}));
  RenderOptions options = small();
  const auto width_of = [&](const Image& image, int from, int to) {
    int columns = 0;
    for (int x = from; x < to; ++x) {
      bool hit = false;
      for (int y = 0; y < image.height; ++y) hit = hit || image.at(x, y) != options.background;
      columns += hit;
    }
    return columns;
  };
  const Image flat = render(mesh, options);
  EXPECT_NEAR(width_of(flat, 0, 80), width_of(flat, 80, 160), 1);
  options.field_of_view_deg = 60;
  const Image deep = render(mesh, options);
  EXPECT_GT(width_of(deep, 0, 80), 1.5 * width_of(deep, 80, 160));
}

TEST(Render, DrawsEdgesAsThinDarkLines) {
  RenderOptions options = small();
  options.occlusion = 0;
  const Image plain = render(make_square(), options);
  options.edges = true;
  const Image lined = render(make_square(), options);
  const auto sum = [](const Color& c) { return c[0] + c[1] + c[2]; };
  EXPECT_LT(sum(lined.at(80, 59)), 0.8 * sum(plain.at(80, 59)));  // on the diagonal
  EXPECT_EQ(lined.at(100, 70), plain.at(100, 70));                // inside a face
}

TEST(Render, ShadesFacetsWhenAskedTo) {
  const TriMesh coarse = make_sphere(5, Vec3::Zero(), 8);
  RenderOptions options = small();
  const Image smooth = render(coarse, options);
  options.smooth = false;
  EXPECT_GT(different_pixels(smooth, render(coarse, options)), 1000u);
}

TEST(Render, DarkensWhereLittleLightGetsIn) {
  TriMesh mesh = make_sphere(5, {-4.9, 0, 0});
  append(mesh, make_sphere(5, {4.9, 0, 0}));
  RenderOptions options = small();
  const Color shaded = center_of(render(mesh, options));
  options.occlusion = 0;
  EXPECT_LT(shaded[0] + 5, center_of(render(mesh, options))[0]);
}

TEST(Render, ColoursByVertexAttributes) {
  const TriMesh square = make_square();
  RenderOptions options = small();
  options.legend = false;
  const Image image = render(square, {"height", {0, 0, 1, 1}}, AttributeDomain::vertex, options);
  EXPECT_TRUE(is_yellow(image.at(80, 12)));
  EXPECT_TRUE(is_dark_violet(image.at(80, 107)));
}

TEST(Render, ColoursByFaceAttributesAndDrawsNanGrey) {
  RenderOptions options = small();
  options.legend = false;
  options.range = {0, 1};
  const Image image = render(make_square(), {"quality", {1, kNan}}, AttributeDomain::face, options);
  EXPECT_TRUE(is_yellow(image.at(105, 80)));
  EXPECT_TRUE(is_grey(image.at(55, 40)));
}

TEST(Render, ColoursCategoriesWithoutMixingThem) {
  RenderOptions options = small();
  options.legend = false;
  options.categories = true;
  options.occlusion = 0;
  const TriMesh square = make_square();
  const auto colors_of = [&](const MeshAttribute& attribute, AttributeDomain domain) {
    const Image image = render(square, attribute, domain, options);
    std::map<Color, int> counts;
    for (int y = 20; y < 100; ++y) {
      for (int x = 40; x < 120; ++x) ++counts[image.at(x, y)];
    }
    std::erase_if(counts, [](const auto& entry) { return entry.second < 300; });  // mixed along the borders
    return counts.size();
  };
  EXPECT_EQ(colors_of({"branch", {4, 5}, true}, AttributeDomain::face), 2u);
  EXPECT_EQ(colors_of({"branch", {4, 4}, true}, AttributeDomain::face), 1u);
  EXPECT_EQ(colors_of({"branch", {1, 2, 3, 4}, true}, AttributeDomain::vertex), 4u);
  EXPECT_EQ(colors_of({"branch", {1, kNan, 1, 1}, true}, AttributeDomain::vertex), 2u);
}

TEST(Render, DrawsALegendOfCategories) {
  RenderOptions options = small();
  options.width = 320;
  options.height = 240;
  options.categories = true;
  const auto column = [&](std::vector<double> labels) {
    return render(make_square(), {"branch", std::move(labels), true}, AttributeDomain::vertex, options);
  };
  const Image two = column({1, 1, 2, 2}), four = column({1, 2, 3, 4});
  EXPECT_GT(different_pixels(two, four, 280), 20u);  // two rows more
  std::vector<double> many;
  TriMesh squares;
  for (int i = 0; i < 200; ++i) {
    append(squares, make_square());
    many.insert(many.end(), {i + 0.0, i + 0.0});
  }
  EXPECT_NO_THROW(render(squares, {"branch", many, true}, AttributeDomain::face, options));
}

TEST(Render, DrawsALegendBesideTheMesh) {
  RenderOptions options = small();
  options.width = 320;
  options.height = 240;
  const MeshAttribute height{"height", {0, 0, 1, 1}};
  const Image with = render(make_square(), height, AttributeDomain::vertex, options);
  bool yellow = false, violet = false, ink = false;
  for (int y = 0; y < 240; ++y) {
    for (int x = 260; x < 320; ++x) {
      const Color c = with.at(x, y);
      yellow = yellow || is_yellow(c);
      violet = violet || is_dark_violet(c);
      ink = ink || (is_grey(c) && c[0] < 110);
    }
  }
  EXPECT_TRUE(yellow && violet && ink);
  options.legend = false;
  const Image without = render(make_square(), height, AttributeDomain::vertex, options);
  EXPECT_EQ(without.at(319, 120), options.background);
  // The name is there too: another one, other pixels.
  options.legend = true;
  const Image renamed = render(make_square(), {"weight", height.values}, AttributeDomain::vertex, options);
  EXPECT_GT(different_pixels(with, renamed, 240), 5u);
}

TEST(Render, GivesTheSamePictureEveryTime) {
  RenderOptions options = small();
  options.edges = true;
  options.view = view_direction("iso");
  const TriMesh sphere = make_sphere(5);
  const MeshAttribute attribute{"index", std::vector<double>(sphere.faces.size(), 0.5)};
  const Image first = render(sphere, attribute, AttributeDomain::face, options);
  EXPECT_EQ(first.pixels, render(sphere, attribute, AttributeDomain::face, options).pixels);
}

TEST(Render, GivesTheSamePictureWithAnyNumberOfThreads) {
  RenderOptions options = small();
  options.edges = true;
  const TriMesh sphere = make_sphere(5, Vec3::Zero(), 200);  // more vertices than are lit at a time
  MeshAttribute height{"height", {}};
  for (const Vec3& p : sphere.vertices) height.values.push_back(p.z());
  const auto with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return render(sphere, height, AttributeDomain::vertex, options).pixels; });
  };
  const auto one = with(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(with(threads), one) << threads;
}

TEST(Render, MayUseAllThreads) {
  const auto allowed = [] { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
  const std::size_t before = allowed();
  std::size_t least = before;
  render(make_sphere(5), small(), [&](std::string_view, double) {
    least = std::min(least, allowed());
    return true;
  });
  EXPECT_EQ(least, before);
}

TEST(Render, TellsHowFarItIsAndStopsWhenAskedTo) {
  std::map<std::string, std::vector<double>, std::less<>> told;
  const TriMesh sphere = make_sphere(5, Vec3::Zero(), 200);
  render(sphere, small(), [&](std::string_view stage, double fraction) {
    told[std::string(stage)].push_back(fraction);
    return true;
  });
  for (const char* stage : {"light", "picture"}) {
    EXPECT_GT(told[stage].size(), 1u) << stage;
    EXPECT_TRUE(std::is_sorted(told[stage].begin(), told[stage].end())) << stage;
    EXPECT_LT(told[stage].back(), 1) << stage;
  }
  EXPECT_THROW(render(sphere, small(), [](std::string_view stage, double) { return stage != "picture"; }), Cancelled);
}

TEST(Render, KeepsTheMeshClearOfTheLegend) {
  RenderOptions options = small();
  options.width = 320;
  options.height = 240;
  options.occlusion = 0;
  const MeshAttribute height{"height", {0, 0, 1, 1}};
  const Image whole = render(make_square(), height, AttributeDomain::vertex, options);
  options.zoom = 10;  // far beyond the picture
  const Image close = render(make_square(), height, AttributeDomain::vertex, options);
  const int legend = 320 - legend_width({"height", 0, 1, false, false, {}}, 320, 240);
  EXPECT_EQ(different_pixels(whole, close, legend), 0u);
  EXPECT_NE(close.at(legend - 1, 120), options.background);
}

TEST(Render, TellsHowManyCategoriesTheLegendLeavesOut) {
  RenderOptions options = small();
  options.categories = true;
  const auto legend_of = [&](int labels) {
    TriMesh squares;
    MeshAttribute segment{"segment", {}, true};
    for (int i = 0; i < labels; ++i) {
      append(squares, make_square());
      segment.values.insert(segment.values.end(), {i + 0.0, i + 0.0});
    }
    return render(squares, segment, AttributeDomain::face, options);
  };
  const int column = 160 - legend_width({"segment", 0, 0, false, false, std::vector<double>(100, 0)}, 160, 120);
  EXPECT_GT(different_pixels(legend_of(100), legend_of(101), column), 0u);
}

TEST(Render, SurvivesDegenerateMeshes) {
  const Vec3 p(3, 4, 5);
  EXPECT_NO_THROW(render({{p, p, p}, {{0, 1, 2}}}, small()));
  RenderOptions options = small();
  options.edges = true;
  options.field_of_view_deg = 40;
  EXPECT_NO_THROW(render({{p, p, p}, {{0, 0, 0}}}, options));
  // Vertices that no face uses do not count.
  TriMesh sphere = make_sphere(5);
  sphere.vertices.push_back({1e6, 0, 0});
  EXPECT_TRUE(is_red(center_of(render(sphere, small()))));
  // The eye may be inside the mesh.
  options.look_at = Vec3::Zero();
  options.view_height_mm = 1;
  EXPECT_NO_THROW(render(make_sphere(5), options));
}

TEST(Render, RejectsWhatItCannotDraw) {
  EXPECT_THROW(render({}, small()), InvalidInput);
  EXPECT_THROW(render({{Vec3::Zero()}, {}}, small()), InvalidInput);
  EXPECT_THROW(render({{Vec3::Zero()}, {{0, 0, 1}}}, small()), InvalidInput);
  TriMesh square = make_square();
  square.vertices[2].x() = kNan;
  EXPECT_THROW(render(square, small()), InvalidInput);
}

TEST(Render, RejectsOptionsOutOfRange) {
  const auto rejected = [](auto&& change) {
    RenderOptions options = small();
    change(options);
    EXPECT_THROW(render(make_square(), options), InvalidInput);
  };
  rejected([](auto& o) { o.width = 0; });
  rejected([](auto& o) { o.height = 20000; });
  rejected([](auto& o) { o.zoom = 0; });
  rejected([](auto& o) { o.zoom = kNan; });
  rejected([](auto& o) { o.view.azimuth_deg = kNan; });
  rejected([](auto& o) { o.look_at = Vec3(0, kNan, 0); });
  rejected([](auto& o) { o.view_height_mm = -1; });
  rejected([](auto& o) { o.field_of_view_deg = 120; });
  rejected([](auto& o) { o.edge_width_px = 0; });
  rejected([](auto& o) { o.occlusion = 1.5; });
  rejected([](auto& o) { o.range = {1, 0}; });
}

TEST(Render, RejectsAttributesThatDoNotFit) {
  const auto draw = [](std::vector<double> values, AttributeDomain domain) {
    return render(make_square(), {"a", std::move(values)}, domain, small());
  };
  EXPECT_THROW(draw({1, 2, 3}, AttributeDomain::vertex), InvalidInput);
  EXPECT_THROW(draw({1, 2, 3, 4}, AttributeDomain::face), InvalidInput);
  EXPECT_THROW(draw({kNan, kNan}, AttributeDomain::face), InvalidInput);
  EXPECT_NO_THROW(draw({2, 2}, AttributeDomain::face));
  EXPECT_NO_THROW(draw({-1e308, 1e308}, AttributeDomain::face));
  EXPECT_NO_THROW(draw({-std::numeric_limits<double>::infinity(), 1}, AttributeDomain::face));
}

TEST(RenderByName, TakesTheVertexAttributeAndForLabelsTheFaces) {
  const TriMesh mesh = make_sphere(1);
  MeshAttribute of_vertices{"branch", std::vector<double>(mesh.vertices.size(), 1)};
  MeshAttribute of_faces{"branch", std::vector<double>(mesh.faces.size(), 2)};
  RenderOptions options = small();
  options.categories = true;
  EXPECT_EQ(render(mesh, {{of_vertices}, {of_faces}}, "branch", small()).pixels,
            render(mesh, of_faces, AttributeDomain::face, options).pixels);
  of_vertices.name = of_faces.name = "radius";
  EXPECT_EQ(render(mesh, {{of_vertices}, {of_faces}}, "radius", small()).pixels,
            render(mesh, of_vertices, AttributeDomain::vertex, small()).pixels);
  EXPECT_NE(render(mesh, {{of_vertices}, {of_faces}}, "skewness", small()).pixels,
            render(mesh, of_vertices, AttributeDomain::vertex, small()).pixels);
}

TEST(RenderByName, TakesIntegersForCategoriesUnlessARangeIsGiven) {
  const TriMesh mesh = make_sphere(1);
  MeshAttribute id{"ModelFaceID", {}, true};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) id.values.push_back(1.0 + static_cast<double>(f % 3));
  RenderOptions categories = small(), scale = small();
  categories.categories = true;
  scale.range = {0, 4};
  const auto by_name = [&](const MeshAttribute& attribute, const RenderOptions& options) {
    return render(mesh, {{}, {attribute}}, attribute.name, options).pixels;
  };
  EXPECT_EQ(by_name(id, small()), render(mesh, id, AttributeDomain::face, categories).pixels);
  EXPECT_EQ(by_name(id, scale), render(mesh, id, AttributeDomain::face, scale).pixels);
  EXPECT_NE(by_name(id, small()), by_name(id, scale));
  id.name = "red";  // an amount
  EXPECT_EQ(by_name(id, small()), render(mesh, id, AttributeDomain::face, small()).pixels);
}

TEST(RenderByName, ListsTheNamesForAnUnknownOne) {
  const TriMesh mesh = make_sphere(1);
  const MeshAttributes attributes = {{{"radius", std::vector<double>(mesh.vertices.size(), 1)}},
                                     {{"group", std::vector<double>(mesh.faces.size(), 1)}}};
  try {
    render(mesh, attributes, "thickness", small());
    ADD_FAILURE() << "no exception";
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "there is no attribute thickness to colour by; the surface has radius, group");
  }
  EXPECT_THROW(render(mesh, MeshAttributes(), "radius", small()), InvalidInput);
}

}  // namespace
}  // namespace vmesh
