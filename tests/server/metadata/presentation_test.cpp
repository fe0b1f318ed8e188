// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/presentation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace vitrine::server {
namespace {

using nlohmann::json;

const double kHalf = std::sqrt(0.5);
const std::array<double, 4> kZUp = {-kHalf, 0, 0, kHalf};  // turns z up to y up
const Bounds kBrick{{0, 0, 0}, {1, 2, 3}};

// Applies a patch to `presentation`. Returns the names of the wrong fields.
std::vector<std::string> patch(Presentation& presentation, const json& change) {
  std::vector<std::string> wrong;
  read_presentation(change, presentation, [&](const std::string& field, const std::string& wanted) {
    EXPECT_FALSE(wanted.empty()) << field;
    wrong.push_back(field);
  });
  return wrong;
}

using Names = std::vector<std::string>;

TEST(Presentation, TurnsAboutAnAxisByTheRightHandRule) {
  const PresentationTransform about_z(Presentation{.rotation = {0, 0, kHalf, kHalf}});
  EXPECT_EQ(about_z({1, 0, 0}), (Vec3{0, 1, 0}));
  const PresentationTransform z_up(Presentation{.rotation = kZUp, .scale = 10});
  EXPECT_EQ(z_up({1, 2, 3}), (Vec3{10, 30, -20}));
  EXPECT_EQ(z_up.turned({1, 2, 3}), (Vec3{1, 3, -2}));
}

TEST(Presentation, QuarterTurnsKeepBoxesExact) {
  const Presentation z_up{.rotation = kZUp, .scale = 2};
  EXPECT_TRUE(PresentationTransform(z_up).keeps_axes());
  const Bounds box = presented_box(z_up, kBrick);
  EXPECT_EQ(box.low, (Vec3{0, 0, -4}));
  EXPECT_EQ(box.high, (Vec3{2, 6, 0}));
}

TEST(Presentation, OtherTurnsHaveABoxOfTheirOwn) {
  Presentation tilted{.rotation = {0, 0, std::sin(0.2), std::cos(0.2)}, .scale = 2};
  EXPECT_FALSE(PresentationTransform(tilted).keeps_axes());
  tilted.turned_box = Bounds{{-1, -1, -1}, {1, 1, 1}};
  EXPECT_EQ(presented_box(tilted, kBrick).high, (Vec3{2, 2, 2}));
}

TEST(Presentation, IsTheIdentityByDefault) {
  EXPECT_TRUE(Presentation{}.is_default());
  EXPECT_TRUE(PresentationTransform(Presentation{}).is_identity());
  EXPECT_FALSE(PresentationTransform(Presentation{.scale = 2}).is_identity());
  EXPECT_FALSE(PresentationTransform(Presentation{.rotation = kZUp}).is_identity());
}

TEST(Presentation, LooksFromTheFrontTheRightAndAbove) {
  EXPECT_NEAR(length(direction_of({.azimuth = 0, .elevation = 0}) - Vec3{0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(length(direction_of({.azimuth = 90, .elevation = 0}) - Vec3{1, 0, 0}), 0, 1e-12);
  const Vec3 above = direction_of({.azimuth = 0, .elevation = 90});
  EXPECT_GT(above.y, 0.999);
  EXPECT_GT(above.z, 0) << "what is above the picture must be defined";
}

TEST(Presentation, AMergePatchChangesWhatItNames) {
  Presentation p;
  EXPECT_EQ(patch(p, {{"scale", 25.4}, {"view", {{"azimuth", 90}, {"zoom", 2}}}}), Names{});
  EXPECT_EQ(patch(p, {{"view", {{"elevation", 30}, {"target", {1, 2, 3}}}}}), Names{});
  EXPECT_EQ(p.scale, 25.4);
  EXPECT_EQ(p.view, (PresentedView{90, 30, 2, Vec3{1, 2, 3}}));
  EXPECT_EQ(patch(p, {{"view", nullptr}, {"light", {{"preset", "raking"}, {"angle", 45}}}}),
            Names{});
  EXPECT_EQ(p.view, std::nullopt);
  EXPECT_EQ(p.light, (PresentedLight{"raking", 45}));
  EXPECT_EQ(patch(p, nullptr), Names{});
  EXPECT_TRUE(p.is_default());
}

TEST(Presentation, RotationsHaveLengthOneAndOneSign) {
  Presentation p;
  EXPECT_EQ(patch(p, {{"rotation", {0, 0, 0.70711, -0.70711}}}), Names{});
  double norm = 0;
  for (const double part : p.rotation)
    norm += part * part;
  EXPECT_NEAR(norm, 1, 1e-15);
  EXPECT_GT(p.rotation[3], 0);
  EXPECT_LT(p.rotation[2], 0);
  EXPECT_EQ(patch(p, {{"rotation", nullptr}}), Names{});
  EXPECT_TRUE(p.is_default());
}

TEST(Presentation, NamesEachWrongField) {
  const std::pair<json, std::string> cases[] = {
      {7, ""},
      {{{"rotation", {0, 0, 0}}}, "rotation"},
      {{{"rotation", {0, 0, 0, 0}}}, "rotation"},
      {{{"rotation", {1, 1, 0, 0}}}, "rotation"},
      {{{"rotation", {0, 0, 0, "1"}}}, "rotation"},
      {{{"scale", 0}}, "scale"},
      {{{"scale", -1}}, "scale"},
      {{{"scale", "2"}}, "scale"},
      {{{"tilt", 3}}, "tilt"},
      {{{"turned_box", {0, 0, 0, 1, 1, 1}}}, "turned_box"},
      {{{"view", 3}}, "view"},
      {{{"view", {{"zoom", 0}}}}, "view.zoom"},
      {{{"view", {{"elevation", 91}}}}, "view.elevation"},
      {{{"view", {{"target", {1, 2}}}}}, "view.target"},
      {{{"poster", {{"azimuth", 1e9}}}}, "poster.azimuth"},
      {{{"light", {{"preset", "disco"}}}}, "light.preset"},
      {{{"light", json::object()}}, "light.preset"},
      {{{"light", {{"preset", "raking"}, {"angle", -1}}}}, "light.angle"}};
  for (const auto& [change, field] : cases) {
    Presentation p;
    EXPECT_EQ(patch(p, change), Names{field}) << change;
  }
}

TEST(Presentation, TheStoredTextBringsAllBack) {
  EXPECT_EQ(stored_text({}), "");
  EXPECT_EQ(client_text({}), "");
  const Presentation p{.rotation = kZUp,
                       .scale = 0.1,
                       .view = PresentedView{12.5, -3, 1.5, Vec3{1, 0.1, -2}},
                       .poster = PresentedView{},
                       .light = PresentedLight{"raking", 10},
                       .turned_box = Bounds{{0, 0, 0}, {1, 1, 1.0 / 3}}};
  EXPECT_EQ(from_stored_text(stored_text(p)), p);
  EXPECT_EQ(client_text(p).find("turned_box"), std::string::npos);
  for (const char* damaged : {"{", "[]", R"({"scale": -2})", R"({"rotation": [1]})"})
    EXPECT_TRUE(from_stored_text(damaged).is_default()) << damaged;
}

TEST(Presentation, KeysDifferWithEachPart) {
  const Presentation all[] = {{},
                              {.scale = 2},
                              {.rotation = kZUp},
                              {.view = PresentedView{}},
                              {.poster = PresentedView{}},
                              {.light = PresentedLight{"relief"}}};
  std::set<std::string> keys;
  for (const Presentation& p : all)
    keys.insert(key_of(p));
  EXPECT_EQ(keys.size(), std::size(all));
}

}  // namespace
}  // namespace vitrine::server
