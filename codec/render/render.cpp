// SPDX-License-Identifier: Apache-2.0
#include "codec/render/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "codec/core/srgb.h"

namespace vitrine::inline codec {
namespace {

constexpr int kSamples = 3;  // samples per pixel on each axis
constexpr double kMargin = 0.03;

Vec3 unit(const Vec3& v) {
  const double l = length(v);
  return l > 0 ? v * (1 / l) : Vec3{0, 0, 1};
}

const Vec3 kToward = unit({0.35, 0.15, 1});  // direction from the model to the eye
const Vec3 kRight = unit(cross({0, 1, 0}, kToward));
const Vec3 kUp = cross(kToward, kRight);

Vec3 to_view(const Vec3& v) {
  return {dot(v, kRight), dot(v, kUp), dot(v, kToward)};
}

Vec3 linear(const Colour& c) {
  return {srgb_to_linear(c[0] / 255.0), srgb_to_linear(c[1] / 255.0), srgb_to_linear(c[2] / 255.0)};
}

// Returns the light on a surface with the normal `n` in view space; 1 is white. There is a lamp at
// the upper left behind the viewer, and ambient light from the sky and the floor.
Vec3 light(const Vec3& n) {
  static const Vec3 lamp = unit({-0.6, 0.9, 1.0});
  static const Vec3 lamp_colour = linear({0xff, 0xfa, 0xf2}) * 0.72;
  static const Vec3 sky = Vec3{1, 1, 1} * 0.34, floor = linear({0x8a, 0x81, 0x78}) * 0.34;
  static const Vec3 up = to_view({0, 1, 0});
  const double high = 0.5 + 0.5 * dot(n, up);
  return lamp_colour * std::max(0.0, dot(n, lamp)) + sky * high + floor * (1 - high);
}

struct ShadedCorner {
  // In samples: x to the right and y down from the picture's top left corner, z towards the eye.
  Vec3 at;
  Vec3 normal, colour;
};

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size());
  for (const Triangle& f : mesh.faces) {
    const Vec3& a = mesh.positions[f[0]];
    const Vec3 n = cross(mesh.positions[f[1]] - a, mesh.positions[f[2]] - a);
    for (const std::uint32_t v : f)
      normals[v] += n;
  }
  return normals;
}

// Returns twice the area of the triangle in the picture; negative if the corners run
// counter-clockwise.
double area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class Canvas {
 public:
  explicit Canvas(const Framing& frame)
      : width_(frame.width * kSamples),
        height_(frame.height * kSamples),
        depth_(std::size_t{width_} * height_, kFar),
        light_(depth_.size()) {}

  void draw(const std::array<ShadedCorner, 3>& t) {
    const double whole = area(t[0].at, t[1].at, t[2].at);
    if (whole == 0) return;
    const auto [left, right] = range(t[0].at.x, t[1].at.x, t[2].at.x, width_);
    const auto [top, bottom] = range(t[0].at.y, t[1].at.y, t[2].at.y, height_);
    for (std::uint32_t y = top; y < bottom; ++y) {
      for (std::uint32_t x = left; x < right; ++x)
        draw_sample(t, whole, x, y);
    }
  }

  Picture develop() const {
    Picture picture{width_ / kSamples, height_ / kSamples, {}};
    picture.pixels.reserve(4 * std::size_t{picture.width} * picture.height);
    for (std::uint32_t y = 0; y < height_; y += kSamples) {
      for (std::uint32_t x = 0; x < width_; x += kSamples)
        add_pixel(picture, x, y);
    }
    return picture;
  }

 private:
  static constexpr float kFar = -std::numeric_limits<float>::infinity();

  // Returns the range of samples whose centres may lie between the coordinates a, b and c.
  static std::array<std::uint32_t, 2> range(double a, double b, double c, std::uint32_t size) {
    const auto inside = [&](double t) {
      return static_cast<std::uint32_t>(std::clamp(t, 0.0, static_cast<double>(size)));
    };
    return {inside(std::ceil(std::min({a, b, c}) - 0.5)),
            inside(std::floor(std::max({a, b, c}) - 0.5) + 1)};
  }

  void draw_sample(const std::array<ShadedCorner, 3>& t, double whole, std::uint32_t x,
                   std::uint32_t y) {
    const Vec3 p{x + 0.5, y + 0.5, 0};
    const double u = area(p, t[1].at, t[2].at) / whole, v = area(t[0].at, p, t[2].at) / whole;
    const double w = 1 - u - v;
    if (u < 0 || v < 0 || w < 0) return;
    const auto depth = static_cast<float>(u * t[0].at.z + v * t[1].at.z + w * t[2].at.z);
    const std::size_t at = std::size_t{y} * width_ + x;
    if (depth <= depth_[at]) return;
    depth_[at] = depth;
    const Vec3 normal = unit(t[0].normal * u + t[1].normal * v + t[2].normal * w);
    const Vec3 colour = t[0].colour * u + t[1].colour * v + t[2].colour * w;
    const Vec3 falling = light(whole < 0 ? normal : normal * -1);
    light_[at] = {static_cast<float>(colour.x * falling.x),
                  static_cast<float>(colour.y * falling.y),
                  static_cast<float>(colour.z * falling.z)};
  }

  void add_pixel(Picture& picture, std::uint32_t left, std::uint32_t top) const {
    std::array<double, 3> sum{};
    int covered = 0;
    for (std::uint32_t y = top; y < top + kSamples; ++y) {
      for (std::size_t at = std::size_t{y} * width_ + left, end = at + kSamples; at < end; ++at) {
        if (depth_[at] == kFar) continue;
        ++covered;
        for (std::size_t c = 0; c < 3; ++c)
          sum[c] += light_[at][c];
      }
    }
    for (const double s : sum) {
      const double mean = covered == 0 ? 0 : std::min(1.0, s / covered);
      picture.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(mean))));
    }
    picture.pixels.push_back(static_cast<std::uint8_t>(255 * covered / (kSamples * kSamples)));
  }

  std::uint32_t width_, height_;
  std::vector<float> depth_;
  std::vector<std::array<float, 3>> light_;
};

}  // namespace

Framing frame_around(const TriangleMesh& mesh, std::uint32_t longest) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low{kInfinity, kInfinity, kInfinity}, high = low * -1;
  for (const Vec3& position : mesh.positions) {
    const Vec3 p = to_view(position);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 size = high - low, middle = (low + high) * 0.5;
  const double longer = std::max(size.x, size.y);
  if (!(longer > 0)) return {.centre = {}, .pixel = 1, .width = longest, .height = longest};
  const auto pixels = [&](double side) {
    return static_cast<std::uint32_t>(std::lround(longest * std::max(0.5, side / longer)));
  };
  return {.centre = kRight * middle.x + kUp * middle.y + kToward * middle.z,
          .pixel = longer * (1 + 2 * kMargin) / longest,
          .width = pixels(size.x),
          .height = pixels(size.y)};
}

Picture render(const TriangleMesh& mesh, const Framing& frame) {
  static const Vec3 stone = linear({0xd8, 0xd3, 0xcb});
  const std::vector<Vec3> normals = vertex_normals(mesh);
  const double samples = kSamples / frame.pixel;  // samples per model unit
  const auto corner = [&](std::uint32_t v) {
    const Vec3 p = to_view(mesh.positions[v] - frame.centre) * samples;
    return ShadedCorner{
        {kSamples * frame.width / 2.0 + p.x, kSamples * frame.height / 2.0 - p.y, p.z},
        unit(to_view(normals[v])),
        mesh.attributes.colours.empty() ? stone : linear(mesh.attributes.colours[v])};
  };
  Canvas canvas(frame);
  for (const Triangle& f : mesh.faces)
    canvas.draw({corner(f[0]), corner(f[1]), corner(f[2])});
  return canvas.develop();
}

}  // namespace vitrine::inline codec
