// SPDX-License-Identifier: Apache-2.0
#include "acquisition/calibration/plane_map.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace vitrine::acquisition {
namespace {

// Largest accepted condition number. Above it, noise of 0.001 pixel could move the map by more than
// a pixel.
constexpr double kWorstCondition = 1e4;
// Tolerance in pixels. It is needed because the hull is computed in single precision.
constexpr double kHullSlack = 1e-3;

int terms_of(int degree) {
  return (degree + 1) * (degree + 2) / 2;
}

// Writes to `row` the products of powers of u and v that belong to the coefficients, in the order
// of PlaneMap::terms_.
void write_powers(double u, double v, int degree, double* row) {
  for (int j = degree; j >= 0; --j) {
    for (int i = degree - j; i >= 0; --i)
      *row++ = std::pow(u, i) * std::pow(v, j);
  }
}

Expected<void> check_points(std::span<const Correspondence> points, int degree, int width,
                            int height) {
  if (degree < PlaneMap::kLeastDegree || degree > PlaneMap::kMostDegree) {
    return fail(ErrorCode::kBadInput,
                fmt::format("a plane map of degree {} is not supported; choose {} to {}", degree,
                            PlaneMap::kLeastDegree, PlaneMap::kMostDegree));
  }
  for (const Correspondence& p : points) {
    const bool inside = p.u >= -0.5 && p.u <= width - 0.5 && p.v >= -0.5 && p.v <= height - 0.5;
    if (!inside || !std::isfinite(p.at.x) || !std::isfinite(p.at.y)) {
      return fail(ErrorCode::kBadInput,
                  fmt::format("a point at pixel ({}, {}) is outside the image of {} x {}; give the "
                              "camera's region in which the points were measured",
                              p.u, p.v, width, height));
    }
  }
  if (points.size() < static_cast<std::size_t>(terms_of(degree))) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{} points do not determine a plane map of degree {}; show the target "
                            "in more poses",
                            points.size(), degree));
  }
  return {};
}

std::vector<double> hull_of(std::span<const Correspondence> points) {
  std::vector<cv::Point2f> all, corners;
  all.reserve(points.size());
  for (const Correspondence& p : points)
    all.emplace_back(static_cast<float>(p.u), static_cast<float>(p.v));
  cv::convexHull(all, corners);
  std::vector<double> hull;
  for (const cv::Point2f& corner : corners)
    hull.insert(hull.end(), {corner.x, corner.y});
  return hull;
}

}  // namespace

Expected<PlaneMap> PlaneMap::fit(std::span<const Correspondence> points, int degree, int width,
                                 int height) {
  if (auto ok = check_points(points, degree, width, height); !ok) {
    return tl::unexpected(ok.error());
  }
  PlaneMap map;
  map.degree_ = degree;
  const auto interval = [&](double Correspondence::*coordinate) {
    const auto [low, high] = std::ranges::minmax_element(points, {}, coordinate);
    const double half = (*high.*coordinate - *low.*coordinate) / 2;
    return Interval{*low.*coordinate + half, half > 0 ? half : 1};
  };
  map.u_ = interval(&Correspondence::u);
  map.v_ = interval(&Correspondence::v);

  const int count = static_cast<int>(points.size()), terms = terms_of(degree);
  cv::Mat_<double> equations(count, terms), targets(count, 2), solution;
  for (int i = 0; i < count; ++i) {
    const Correspondence& p = points[i];
    write_powers(map.u_.normalised(p.u), map.v_.normalised(p.v), degree, equations[i]);
    targets(i, 0) = p.at.x;
    targets(i, 1) = p.at.y;
  }
  const cv::SVD svd(equations, cv::SVD::MODIFY_A);
  const double least = svd.w.at<double>(terms - 1), most = svd.w.at<double>(0);
  if (!(least > most / kWorstCondition)) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the points cover too little of the image to determine a plane map of "
                            "degree {}; show the target in more places, or choose a lower degree",
                            degree));
  }
  map.condition_ = most / least;
  svd.backSubst(targets, solution);
  for (int i = 0; i < terms; ++i)
    map.terms_.push_back({solution(i, 0), solution(i, 1)});
  map.hull_ = hull_of(points);
  return map;
}

double PlaneMap::image_share(int width, int height) const {
  double area = 0;
  for (std::size_t i = 0; i < hull_.size(); i += 2) {
    const std::size_t next = (i + 2) % hull_.size();
    area += (hull_[i] * hull_[next + 1] - hull_[next] * hull_[i + 1]) / 2;
  }
  return std::abs(area) / (static_cast<double>(width) * height);
}

bool PlaneMap::is_inside(double u, double v) const {
  const std::size_t n = hull_.size();
  if (n == 0) return false;
  double u0 = hull_[n - 2], v0 = hull_[n - 1];
  for (std::size_t i = 0; i < n; i += 2) {
    const double du = hull_[i] - u0, dv = hull_[i + 1] - v0;
    const double outwards = dv * (u - u0) - du * (v - v0);
    if (!(outwards <= kHullSlack * (std::abs(du) + std::abs(dv)))) return false;
    u0 = hull_[i];
    v0 = hull_[i + 1];
  }
  return true;
}

// Evaluates the polynomials by Horner's scheme. The inner loop runs over powers of u, the outer
// loop over powers of v.
PlanePoint PlaneMap::evaluate(double u, double v) const {
  PlanePoint sum;
  const Terms* term = terms_.data();
  for (int in_u = 0; in_u <= degree_; ++in_u) {
    double x = term->x, y = term->y;
    ++term;
    for (int i = 0; i < in_u; ++i, ++term) {
      x = x * u + term->x;
      y = y * u + term->y;
    }
    sum.x = sum.x * v + x;
    sum.y = sum.y * v + y;
  }
  return sum;
}

std::optional<PlanePoint> PlaneMap::at(double u, double v) const {
  if (!is_inside(u, v)) return std::nullopt;
  return evaluate(u_.normalised(u), v_.normalised(v));
}

}  // namespace vitrine::acquisition
