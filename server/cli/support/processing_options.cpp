// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/processing_options.h"

#include "acquisition/session/scan_request.h"

namespace vitrine::server::cli {
namespace {

// Reads a flag that takes one of `choices`. Leaves `value` unchanged if the flag is absent.
CommandOutcome read_choice(const Arguments& arguments, const Flag& flag,
                           std::span<const std::string_view> choices, auto& value) {
  if (!arguments.has(flag.name)) return {};
  return arguments.choice(flag.name, choices).map([&](std::size_t place) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(place);
  });
}

CommandOutcome read_length(const Arguments& arguments, int& window) {
  constexpr std::string_view kLengths[] = {"5", "10", "15", "20"};
  if (!arguments.has(kLengthFlag.name)) return {};
  return arguments.choice(kLengthFlag.name, kLengths).map([&](std::size_t place) {
    window = 5 * (static_cast<int>(place) + 1);
  });
}

CommandOutcome read_number(const Arguments& arguments, const Flag& flag, double most,
                           double& value) {
  return arguments.number_between(flag.name, 0, most).map([&](std::optional<double> given) {
    value = given.value_or(value);
  });
}

}  // namespace

tl::expected<acquisition::Processing, Fault> processing_options(
    const Arguments& arguments, const acquisition::Processing& otherwise) {
  acquisition::Processing result = otherwise;
  auto& [stripe, sampling, surface] = result;
  CommandOutcome read =
      read_choice(arguments, kStripeFlag, acquisition::kStripeNames, stripe.method);
  if (read)
    read = read_choice(arguments, kSamplingFlag, acquisition::kSamplingNames, sampling.method);
  if (read) read = read_length(arguments, sampling.window);
  if (read)
    read =
        read_number(arguments, kLargestAngleFlag, acquisition::kMostAngle, surface.largest_angle);
  if (read)
    read = read_number(arguments, kLargestHoleFlag, acquisition::kMostHole, surface.largest_hole);
  if (!read) return tl::unexpected(read.error());
  return result;
}

}  // namespace vitrine::server::cli
