// Files of parts: what was written is read back, and damaged files are refused, whatever the damage.
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "vmesh/core/error.h"
#include "vmesh/parts/join.h"
#include "vmesh/synth/synthetic_tree.h"

namespace vmesh {
namespace {

namespace fs = std::filesystem;

ConeOrigins plain_origins(const SurfacePart& part) {
  ConeOrigins origins;
  origins.offsets.push_back(0);
  for (const Index cone : part.field.cone) {
    origins.stretch.emplace_back();
    origins.pieces.push_back({cone, 0, 0, 1});
    origins.within.emplace_back();
    origins.branch.push_back(cone % 7);
    origins.offsets.push_back(static_cast<Index>(origins.pieces.size()));
  }
  origins.node = part.field.node;
  return origins;
}

class PartFiles : public ::testing::Test {
 protected:
  PartFiles() : folder_(fs::temp_directory_path() / ("vmesh_parts_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    GenerateOptions options;
    options.simplification = 0;
    const SplitSummary split =
        split_surface(synthetic_tree({.vertices = 200, .seed = 4}), options, 800, [&](SurfacePart part) {
          ConeOrigins origins = plain_origins(part);
          parts_.push_back({"some id", std::move(part), std::move(origins)});
        });
    manifest_ = {"some id",
                 {"vmesh", "--around 6", "tree.swc", "0123"},
                 split.parts,
                 split.pieces,
                 split.seams,
                 6,
                 split.components,
                 split.cycle_rank,
                 split.expected_vertices,
                 {}};
  }
  ~PartFiles() override { fs::remove_all(folder_); }

  void write_all() {
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      write_part(part(p), parts_[p]);
      write_part_surface(surface(p), refer_to_read(parts_[p], grow_part(parts_[p].part, 1)));
    }
    write_manifest(folder_ / kManifestName, manifest_);
  }
  fs::path part(std::size_t p) const { return folder_ / (part_name(p) + kPartExtension); }
  fs::path surface(std::size_t p) const { return folder_ / (part_name(p) + kPartSurfaceExtension); }
  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void write(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

  fs::path folder_;
  std::vector<StoredPart> parts_;
  PartsManifest manifest_;
};

class CountingSink : public SurfaceSink {
 public:
  void begin(std::size_t v, std::size_t f) override {
    vertices = v;
    faces = f;
  }
  void add(const Vertices& block) override {
    vertices_seen += block.position.size();
    EXPECT_EQ(block.normal.size(), block.position.size());
    for (const Vec3& n : block.normal) EXPECT_NEAR(n.norm(), 1, 1e-12);
  }
  void add(const Faces& block) override {
    EXPECT_EQ(vertices_seen, vertices);
    faces_seen += block.corners.size();
    for (const Triangle& f : block.corners) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LT(f[k], vertices);
        EXPECT_TRUE(edges.insert({f[k], f[(k + 1) % 3]}).second);
      }
    }
  }

  std::size_t vertices = 0, faces = 0, vertices_seen = 0, faces_seen = 0;
  std::set<std::pair<Index, Index>> edges;
};

TEST_F(PartFiles, ComeBackAsTheyWereWritten) {
  write_all();
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const StoredPart back = read_part(part(p));
    EXPECT_EQ(back.id, "some id");
    EXPECT_EQ(back.part.pieces, parts_[p].part.pieces);
    write_part(folder_ / "again.vpart", back);
    EXPECT_EQ(read(folder_ / "again.vpart"), read(part(p)));
    write_part_surface(folder_ / "again.vsurf", read_part_surface(surface(p)));
    EXPECT_EQ(read(folder_ / "again.vsurf"), read(surface(p)));
    // A part read from a file grows like the one written.
    write_part_surface(folder_ / "again.vsurf", refer_to_read(back, grow_part(back.part, 1)));
    EXPECT_EQ(read(folder_ / "again.vsurf"), read(surface(p)));
  }
  write_manifest(folder_ / "again.json", read_manifest(folder_ / kManifestName));
  EXPECT_EQ(read(folder_ / "again.json"), read(folder_ / kManifestName));
}

TEST_F(PartFiles, AreJoinedToAClosedSurface) {
  write_all();
  CountingSink sink;
  const JoinSummary summary = join_parts(folder_, sink, 1);
  EXPECT_TRUE(summary.is_sound());
  EXPECT_EQ(sink.vertices_seen, sink.vertices);
  EXPECT_EQ(sink.faces_seen, sink.faces);
  EXPECT_EQ(summary.euler_characteristic, 2);
  for (const auto& [a, b] : sink.edges) EXPECT_TRUE(sink.edges.contains({b, a}));
  EXPECT_LT(summary.max_skewness, 0.5);
  EXPECT_EQ(summary.growth.pieces, manifest_.pieces);
}

TEST_F(PartFiles, ThatAreNotTheWholeAreRefused) {
  write_all();
  CountingSink sink;
  const std::string second = read(surface(1));
  fs::remove(surface(1));
  EXPECT_THROW(join_parts(folder_, sink, 1), ReadError);
  write(surface(1), read(surface(0)));
  EXPECT_THROW(join_parts(folder_, sink, 1), InvalidInput);
  write(surface(1), second);
  manifest_.id = "another";
  write_manifest(folder_ / kManifestName, manifest_);
  EXPECT_THROW(join_parts(folder_, sink, 1), InvalidInput);
  manifest_.id = "some id";
  --manifest_.parts;
  write_manifest(folder_ / kManifestName, manifest_);
  EXPECT_THROW(join_parts(folder_, sink, 1), InvalidInput);
  EXPECT_EQ(sink.vertices_seen, 0u);
}

TEST_F(PartFiles, CutOffAnywhereAreRefused) {
  write_all();
  for (const fs::path& path : {part(0), surface(0)}) {
    const std::string whole = read(path);
    const bool is_part = path == part(0);
    for (int i = 0; i < 60; ++i) {
      write(folder_ / "cut", whole.substr(0, whole.size() * static_cast<std::size_t>(i) / 60));
      if (is_part) {
        EXPECT_THROW(read_part(folder_ / "cut"), InvalidInput) << i;
      } else {
        EXPECT_THROW(read_part_surface(folder_ / "cut"), InvalidInput) << i;
      }
    }
  }
}

// Bytes changed at random are detected by the checksum; where that is not verified again, they do no harm.
TEST_F(PartFiles, DamagedAnywhereAreRefused) {
  write_all();
  std::mt19937 random(1);
  const std::string part_bytes = read(part(0)), surface_bytes = read(surface(0));
  for (int i = 0; i < 300; ++i) {
    std::string bytes = i % 2 == 0 ? part_bytes : surface_bytes;
    for (int k = 0; k < 1 + i % 5; ++k) {
      // Half of them in the header.
      const std::size_t range = k % 2 == 0 ? std::min<std::size_t>(bytes.size(), 3000) : bytes.size();
      bytes[random() % range] ^= static_cast<char>(1 + random() % 255);
    }
    write(folder_ / "damaged", bytes);
    if (i % 2 == 0) {
      EXPECT_THROW(read_part(folder_ / "damaged"), InvalidInput) << i;
    } else {
      EXPECT_THROW(read_part_surface(folder_ / "damaged"), InvalidInput) << i;
      try {
        read_part_surface(folder_ / "damaged", false);
      } catch (const InvalidInput&) {
      }
    }
  }
}

TEST_F(PartFiles, ThatAreNoneAreRefused) {
  EXPECT_THROW(read_part(folder_ / "missing.vpart"), ReadError);
  write(folder_ / "other.vpart", "ply\nformat ascii 1.0\n");
  EXPECT_THROW(read_part(folder_ / "other.vpart"), InvalidInput);
  write(folder_ / "empty.vpart", "");
  EXPECT_THROW(read_part(folder_ / "empty.vpart"), InvalidInput);
  write_all();
  EXPECT_THROW(read_part(surface(0)), InvalidInput);
  EXPECT_THROW(read_part_surface(part(0)), InvalidInput);
  write(folder_ / kManifestName, "{}");
  EXPECT_THROW(read_manifest(folder_ / kManifestName), InvalidInput);
}

}  // namespace
}  // namespace vmesh
