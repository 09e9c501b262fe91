#include <memory>

#include "tests/support/catch.hpp"
#include "tests/viewer/frames.hpp"
#include "viewer/scene_message.hpp"

using namespace irdm;
using namespace irdm::test;
using namespace irdm::viewer;

TEST_CASE("the bytes of an object's regions are those of the document") {
  Scene scene = one_point_scene();
  const std::size_t before = encode(scene).size();
  SceneRegions regions = example_regions();
  regions.surface_modulus.resize(1);
  regions.some_unlisted = false;
  regions.faces_left_out = true;
  scene.objects[0].regions = regions;
  const Bytes bytes = encode(scene);
  CHECK(Bytes(bytes.begin() + 96, bytes.begin() + 100) == from_hex("0200 0200"));
  CHECK(added_after(bytes, before) ==
        from_hex("00000000 0000fa44 0000fa44 0000803e 0000003f 00007a44 00007a44"
                 "03000000 0000fa43 0000fa45 0000803e 0000803e 00008044 00008044 |"
                 "0000fa44 | 03000000 01000000"
                 "0000003f 00000000 00000000 00000000 0000003f 00000000"
                 "00000000 00000000 000000bf | 00000000 02000000 01000000 | 0000fa43"));
}

TEST_CASE("regions that break the rules are refused") {
  Scene scene = one_point_scene();
  const std::size_t at = encode(scene).size();
  scene.objects[0].regions = example_regions();
  scene.objects[0].regions.surface_modulus.resize(1);
  Bytes bytes = encode(scene);
  CHECK_NOTHROW(decode_scene(bytes));
  const std::size_t counts = at + 2 * 28 + 4;
  SECTION("more than can be listed") {
    bytes[96] = kMaxRegions + 1;
  }
  SECTION("more than there are bytes") {
    bytes[96] = kMaxRegions;
  }
  SECTION("none, and yet their bytes") {
    bytes[96] = 0;
  }
  SECTION("a least value above the greatest") {
    bytes[at + 7] = 0x45;
  }
  SECTION("a least value that is not a number") {
    bytes[at + 6] = 0xC0;
    bytes[at + 7] = 0x7F;
  }
  SECTION("no modulus") {
    for (std::size_t i = 4; i < 8; ++i) bytes[at + i] = 0;
  }
  SECTION("an infinite modulus at the surface") {
    bytes[counts - 2] = 0x80;
    bytes[counts - 1] = 0x7F;
  }
  SECTION("a modulus of a face that is not a number") {
    bytes[bytes.size() - 2] = 0xC0;
    bytes[bytes.size() - 1] = 0x7F;
  }
  SECTION("more nodes than bytes") {
    bytes[counts + 3] = 1;
  }
  SECTION("more faces than bytes") {
    bytes[counts + 4] = 2;
  }
  SECTION("a node that is not there") {
    bytes[counts + 8 + 36] = 3;
  }
  SECTION("cut") {
    bytes.pop_back();
  }
  CHECK_THROWS_AS(decode_scene(bytes), MessageError);
}

TEST_CASE("faces inside an object have a limit") {
  Scene scene = one_point_scene();
  SceneRegions regions = example_regions();
  regions.surface_modulus.resize(1);
  const std::size_t more = GENERATE(0, 1);
  regions.faces = Triangles::Zero(static_cast<Eigen::Index>(kMaxRegionFaces + more), 3);
  regions.face_modulus.resize(kMaxRegionFaces + more, 1.0F);
  scene.objects[0].regions = regions;
  const Bytes bytes = encode(scene);
  if (more == 0) {
    CHECK(decode_scene(bytes).objects[0].regions.faces.rows() == kMaxRegionFaces);
  } else {
    CHECK_THROWS_AS(decode_scene(bytes), MessageError);
  }
}

TEST_CASE("viewers are sent the regions of a model") {
  Model cube = synthetic_cube(2, 1, 1);
  cube.material.elements = {{8000.0}, {0.25}, {1024.0}, {3}};
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(cube);
  const SceneRegions regions = viewer_scene({"cube"}, config).objects.at(0).regions;
  REQUIRE(regions.regions.size() == 1);
  CHECK(regions.regions[0].number == 3);
  CHECK(regions.regions[0].density.highest == 1024.0F);
}
