// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace vitrine::rig {
namespace {

constexpr std::string_view kUsage =
    R"(usage: vitrine-rig (--mesh FILE | --empty) [OPTION]... -- COMMAND [ARGUMENT]...

Simulates a laser scanner: a GigE Vision camera on a loopback address and a motor board on a USB bus
that only COMMAND sees. Runs COMMAND and exits as it does.

  --mesh FILE          what stands on the table: PLY, OBJ, STL, OFF or GLB
  --up AXIS            the file's axis that points upwards: x, y, z, -x, -y, -z (default y)
  --height-mm MM       its height on the table (default 80)
  --empty              nothing stands on the table, and the laser meets its bare plate: under an
                       object lies black cloth, which shows no light
  --seed N             which rig: geometry, serial numbers and noise (default 1)
  --steps N            the scanner's steps a turn, for --write-config (default 720)
  --degrees-per-second N
                       how fast the table turns (default: it is there at once)
  --table FILE         keeps where the table stands for the next rig, so that it can go on with a scan
                       (default: each begins at 0 degrees)
  --fault NAME[@STEP]  what goes wrong, at that motion of the table; may be repeated: lost-packets,
                       camera-unplug, usb-unplug, motor-stall, missed-trigger, drift,
                       laser-out, second-stripe
  --stripe SHAPE       gaussian, top-hat or skewed (default gaussian)
  --speckle CONTRAST   of the laser's light, 0.33 to 1 (default 0.33)
  --matt               no paint of another albedo and no gloss
  --ideal              no noise, no speckle, a motor without error: to compare methods, never to
                       state accuracy
  --address IP         the camera's, of an interface of this machine (default 127.0.0.1); one rig an
                       address
  --private-network    camera and COMMAND on a loopback of their own: several rigs on one machine. A
                       rig that COMMAND starts there may have the address 127.0.0.2
  --dialect NAME       the board's: horus or fabscan (default horus)
  --write-config FILE  what `vitrine` is to know of the scanner, as JSON
  --name NAME          the scanner's in there (default rig)
  --write-commands FILE
                       what the board is told, a line each, after the time in milliseconds since
                       1970
  --write-truth FILE   the object in the table's frame at 0 degrees in mm, as PLY, with a flag
                       `seen` a vertex: visible to laser and camera; then no COMMAND is needed
  --help, --version)";

Unexpected wrong(std::string_view option, std::string_view value, std::string_view wanted) {
  return fail(ErrorCode::kBadInput, fmt::format("{} {}: give {}", option, value, wanted));
}

template <class T>
Expected<T> number(std::string_view option, std::string_view value, T low, T high,
                   std::string_view wanted) {
  T parsed{};
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), parsed);
  if (error != std::errc() || end != value.data() + value.size() || !(parsed >= low) ||
      !(parsed <= high)) {
    return wrong(option, value, wanted);
  }
  return parsed;
}

// Stores what an option says, or tells what it should say.
class Parser {
 public:
  Expected<RigOptions> parse(std::span<const std::string_view> words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] == "--") {
        options_.command.assign(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
        break;
      }
      if (set_switch(words[i])) continue;
      if (!takes_value(words[i]))
        return fail(ErrorCode::kBadInput, fmt::format("{}: unknown; see --help", words[i]));
      if (i + 1 == words.size())
        return fail(ErrorCode::kBadInput, fmt::format("{}: needs a value; see --help", words[i]));
      const auto set = set_value(words[i], words[i + 1]);
      if (!set) return Unexpected(set.error());
      ++i;
    }
    return finish();
  }

 private:
  bool set_switch(std::string_view word) {
    if (word == "--help") return options_.help = true;
    if (word == "--version") return options_.version = true;
    if (word == "--empty") return empty_ = true;
    if (word == "--private-network") return options_.private_network = true;
    if (word == "--ideal") return options_.realism.ideal = true;
    if (word != "--matt") return false;
    options_.finish = {.painted = false, .gloss = 0};
    return true;
  }

  static bool takes_value(std::string_view word) {
    constexpr std::string_view kNames[] = {"--mesh",          "--up",      "--height-mm",
                                           "--seed",          "--steps",   "--degrees-per-second",
                                           "--fault",         "--stripe",  "--speckle",
                                           "--address",       "--dialect", "--write-config",
                                           "--write-truth",   "--name",    "--table",
                                           "--write-commands"};
    return std::find(std::begin(kNames), std::end(kNames), word) != std::end(kNames);
  }

  template <class T>
  Expected<void> store(T& to, const Expected<T>& value) {
    if (!value) return Unexpected(value.error());
    to = *value;
    return {};
  }

  Expected<void> set_value(std::string_view option, std::string_view value) {
    if (option == "--height-mm")
      return store(placed_.height_mm, number(option, value, 1.0, 95.0, "1 to 95 mm"));
    if (option == "--seed")
      return store(options_.realism.seed,
                   number(option, value, std::uint64_t{0}, ~std::uint64_t{0}, "a whole number"));
    if (option == "--steps")
      return store(options_.steps, number(option, value, 1, 28800, "1 to 28800"));
    if (option == "--degrees-per-second")
      return store(options_.degrees_per_second, number(option, value, 1.0, 1e4, "1 to 10000"));
    if (option == "--speckle")
      return store(options_.realism.look.speckle, number(option, value, 0.33, 1.0, "0.33 to 1"));
    if (option == "--fault") return add_fault(value);
    return set_word(option, value);
  }

  Expected<void> add_fault(std::string_view value) {
    const auto fault = parse_fault(value);
    if (!fault) return Unexpected(fault.error());
    options_.faults.push_back(*fault);
    return {};
  }

  Expected<void> set_word(std::string_view option, std::string_view value) {
    const auto choose = [&](std::string& to, std::span<const std::string_view> choices,
                            std::string_view wanted) -> Expected<void> {
      if (std::find(choices.begin(), choices.end(), value) == choices.end())
        return wrong(option, value, wanted);
      to = value;
      return {};
    };
    constexpr std::string_view kAxes[] = {"x", "y", "z", "-x", "-y", "-z"};
    constexpr std::string_view kDialects[] = {"horus", "fabscan"};
    if (option == "--up") return choose(placed_.up, kAxes, "x, y, z, -x, -y or -z");
    if (option == "--dialect") return choose(options_.dialect, kDialects, "horus or fabscan");
    if (option == "--stripe") return set_stripe(value);
    if (option == "--mesh") placed_.file = value;
    if (option == "--address") options_.address = value;
    if (option == "--write-config") options_.write_config = value;
    if (option == "--name") options_.name = value;
    if (option == "--write-truth") options_.write_truth = value;
    if (option == "--table") options_.table = value;
    if (option == "--write-commands") options_.write_commands = value;
    return {};
  }

  Expected<void> set_stripe(std::string_view value) {
    StripeShape& shape = options_.realism.look.shape;
    if (value == "gaussian") return shape = StripeShape::kGaussian, Expected<void>{};
    if (value == "top-hat") return shape = StripeShape::kTopHat, Expected<void>{};
    if (value == "skewed") return shape = StripeShape::kSkewed, Expected<void>{};
    return wrong("--stripe", value, "gaussian, top-hat or skewed");
  }

  Expected<RigOptions> finish() {
    if (options_.help || options_.version) return options_;
    if (empty_ != placed_.file.empty())
      return fail(ErrorCode::kBadInput, "what stands on the table? Give --mesh FILE or --empty");
    if (!empty_) options_.object = placed_;
    if (empty_ && !options_.write_truth.empty())
      return fail(ErrorCode::kBadInput, "--write-truth: an empty table has none; give --mesh FILE");
    if (options_.command.empty() && options_.write_truth.empty())
      return fail(ErrorCode::kBadInput, "no command to run; give one after --");
    return options_;
  }

  RigOptions options_;
  PlacedMesh placed_;
  bool empty_ = false;
};

}  // namespace

std::string_view usage() {
  return kUsage;
}

Expected<RigOptions> parse_options(std::span<const std::string_view> words) {
  return Parser().parse(words);
}

}  // namespace vitrine::rig
