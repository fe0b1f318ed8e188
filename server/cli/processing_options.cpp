// SPDX-License-Identifier: Apache-2.0
#include "server/cli/processing_options.h"

#include "acquisition/session/scan_request.h"

namespace vitrine::cli {
namespace {

// Leaves `value` as it is where the flag is absent.
Outcome read_choice(const Arguments& arguments, const Flag& flag,
                    std::span<const std::string_view> choices, auto& value) {
  if (!arguments.has(flag.name)) return {};
  return arguments.choice(flag.name, choices).map([&](std::size_t place) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(place);
  });
}

Outcome read_length(const Arguments& arguments, int& window) {
  constexpr std::string_view kLengths[] = {"5", "10", "15", "20"};
  if (!arguments.has(kLengthFlag.name)) return {};
  return arguments.choice(kLengthFlag.name, kLengths).map([&](std::size_t place) {
    window = 5 * (static_cast<int>(place) + 1);
  });
}

Outcome read_number(const Arguments& arguments, const Flag& flag, double most, double& value) {
  return arguments.number_between(flag.name, 0, most).map([&](std::optional<double> given) {
    value = given.value_or(value);
  });
}

}  // namespace

tl::expected<Processing, Fault> processing_options(const Arguments& arguments,
                                                   const Processing& otherwise) {
  Processing result = otherwise;
  auto& [stripe, sampling, surface] = result;
  Outcome read = read_choice(arguments, kStripeFlag, kStripeNames, stripe.method);
  if (read) read = read_choice(arguments, kSamplingFlag, kSamplingNames, sampling.method);
  if (read) read = read_length(arguments, sampling.window);
  if (read) read = read_number(arguments, kLargestAngleFlag, kMostAngle, surface.largest_angle);
  if (read) read = read_number(arguments, kLargestHoleFlag, kMostHole, surface.largest_hole);
  if (!read) return tl::unexpected(read.error());
  return result;
}

}  // namespace vitrine::cli
