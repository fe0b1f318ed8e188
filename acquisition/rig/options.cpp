// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "codec/import/formats.h"

namespace vitrine::acquisition::rig {
namespace {

// The text of --help. {} stands for the list of mesh formats.
constexpr std::string_view kUsage =
    R"(Usage: vitrine-rig (--mesh FILE | --empty) [OPTION]... -- COMMAND [ARGUMENT]...
       vitrine-rig --mesh FILE --write-truth FILE [OPTION]...

Simulates a laser scanner: a GigE Vision camera on a loopback address and a motor board on a USB bus
that only COMMAND sees. Runs COMMAND and exits with its exit code.

  --mesh FILE          the object on the table: {}
  --up AXIS            the file's upward axis: x, y, z, -x, -y or -z (default y)
  --height-mm MM       height of the object, 1 to 95 (default 80)
  --empty              no object: the laser meets the bare plate of the table (with an object, the
                       plate is covered by black cloth, which reflects no light)
  --seed N             seed of geometry, serial numbers and noise: each seed gives a different rig
                       (default 1)
  --steps N            steps of a scan in one revolution, written by --write-config (default 720)
  --degrees-per-second N
                       speed of the table (default: motions complete at once)
  --table FILE         file that keeps the table's angle for the next rig, so that a scan can be
                       resumed (default: each rig starts at 0 degrees)
  --fault NAME[@STEP]  simulate a fault after motion STEP of the table; may be repeated. The default
                       of STEP is in parentheses; 0 is the start:
                         lost-packets    one picture in twenty lacks packets (0)
                         camera-unplug   the camera is absent for 5 s (1)
                         usb-unplug      the board is absent for 5 s (1)
                         motor-stall     the table stands still until the board restarts (1)
                         missed-trigger  the next picture is not sent (1)
                         drift           the laser shifts by 2 micrometres with each motion (0)
                         laser-out       the laser stays dark when it is switched on (0)
                         second-stripe   the scanner's second laser is on as well (0)
  --stripe SHAPE       brightness across the line: gaussian, top-hat or skewed (default gaussian)
  --speckle CONTRAST   speckle contrast of the laser's light, 0.33 to 1 (default 0.33)
  --matt               no dark patches painted on the object, and no gloss
  --ideal              no noise, no speckle, no motor error: for comparing methods, not for stating
                       accuracy
  --address IP         address of the camera, on an interface of this machine (default 127.0.0.1);
                       each rig needs its own
  --private-network    run camera and COMMAND on a loopback of their own, for several rigs on one
                       machine; a rig that COMMAND starts there may use the address 127.0.0.2
  --dialect NAME       protocol of the board: horus or fabscan (default horus)
  --write-config FILE  write the scanner's configuration for `vitrine` to FILE, as JSON
  --name NAME          name of the scanner in that configuration (default rig)
  --write-commands FILE
                       write each command that the board receives to FILE, one per line, after the
                       time in milliseconds since 1970
  --write-truth FILE   write the object to FILE as PLY, in mm in the table's frame at 0 degrees,
                       with a flag `seen` for each vertex: visible to laser and camera
  --help, --version    print this help or the version, and exit)";

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

// Parses the command line. Stores the value of each option. If a value is invalid, reports the
// valid values.
class OptionParser {
 public:
  Expected<RigOptions> parse(std::span<const std::string_view> words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] == "--") {
        options_.command.assign(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
        break;
      }
      if (set_switch(words[i])) continue;
      if (!takes_value(words[i]))
        return fail(ErrorCode::kBadInput, fmt::format("{}: unknown option; see --help", words[i]));
      if (i + 1 == words.size())
        return fail(ErrorCode::kBadInput, fmt::format("{}: needs a value; see --help", words[i]));
      const auto set = set_value(words[i], words[i + 1]);
      if (!set) return tl::unexpected(set.error());
      ++i;
    }
    return finish();
  }

 private:
  bool set_switch(std::string_view word) {
    if (word == "--help") return options_.shows_help = true;
    if (word == "--version") return options_.shows_version = true;
    if (word == "--empty") return is_empty_ = true;
    if (word == "--private-network") return options_.has_private_network = true;
    if (word == "--ideal") return options_.realism.is_ideal = true;
    if (word != "--matt") return false;
    options_.finish = {.is_painted = false, .gloss = 0};
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
    if (!value) return tl::unexpected(value.error());
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
    if (!fault) return tl::unexpected(fault.error());
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
    if (options_.shows_help || options_.shows_version) return options_;
    if (is_empty_ != placed_.file.empty())
      return fail(ErrorCode::kBadInput, "give either --mesh FILE or --empty");
    if (!is_empty_) options_.object = placed_;
    if (is_empty_ && !options_.write_truth.empty())
      return fail(ErrorCode::kBadInput,
                  "--write-truth: an empty table has no ground truth; give --mesh FILE");
    if (options_.command.empty() && options_.write_truth.empty())
      return fail(ErrorCode::kBadInput, "no command given; give one after --");
    return options_;
  }

  RigOptions options_;
  ObjectFile placed_;
  bool is_empty_ = false;
};

}  // namespace

std::string usage() {
  return fmt::format(kUsage, std::string_view(kImportFormatNames));
}

Expected<RigOptions> parse_options(std::span<const std::string_view> words) {
  return OptionParser().parse(words);
}

}  // namespace vitrine::acquisition::rig
