// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/target_pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "acquisition/profile/stripe.h"

namespace vitrine::acquisition {
namespace {

// Degrees by which the table turns to find out whether the target turns with it.
constexpr double kProbeAngle = 10;
constexpr double kHeldStill = 2;  // largest motion in pixels of a corner that counts as still

// Returns whether all corners seen in both views have stayed in place.
bool is_same_place(const TargetView& a, const TargetView& b) {
  for (std::size_t i = 0; i < a.ids.size(); ++i) {
    const auto it = std::find(b.ids.begin(), b.ids.end(), a.ids[i]);
    if (it == b.ids.end()) continue;
    const ImagePoint& there = b.corners[static_cast<std::size_t>(it - b.ids.begin())];
    if (std::hypot(a.corners[i].u - there.u, a.corners[i].v - there.v) > kHeldStill) return false;
  }
  return true;
}

class Photographer {
 public:
  Photographer(LiveScanner& scanner, const CharucoTarget& target,
               const TargetPictureOptions& options)
      : scanner_(scanner), target_(target), options_(options) {}

  // Takes all pictures of one placement. If the target does not turn with the table, it is held in
  // front of the table, and one picture is enough.
  Expected<void> take_place(int placement) {
    const auto first = take(placement, 0);
    if (!first) return tl::unexpected(first.error());
    if (*first) {
      if (auto turned = scanner_.turn_to(kProbeAngle); !turned) return turned;
      const auto frame = scanner_.capture();
      if (!frame) return tl::unexpected(frame.error());
      const auto view = find_target(*frame, target_);
      if (view && is_same_place(pictures_.back().view, *view)) return {};
    }
    for (double angle = -options_.largest_angle; angle <= options_.largest_angle;
         angle += options_.angle_step) {
      if (*first && angle == 0) continue;
      if (auto taken = take(placement, angle); !taken) return tl::unexpected(taken.error());
    }
    return {};
  }

  const std::optional<Error>& why_unseen() const { return why_unseen_; }
  std::vector<TargetPicture>& pictures() { return pictures_; }

 private:
  // Takes one picture. Returns whether the picture shows the target.
  Expected<bool> take(int placement, double angle) {
    if (options_.is_interrupted && options_.is_interrupted())
      return fail(ErrorCode::kState, "the calibration was interrupted; start it again");
    if (auto turned = scanner_.turn_to(angle); !turned) return tl::unexpected(turned.error());
    const auto frames = scanner_.capture_pair();
    if (!frames) return tl::unexpected(frames.error());
    auto view = find_target(frames->dark, target_);
    if (!view) {
      why_unseen_ = view.error();
      return false;
    }
    const auto stripe = find_stripe(frames->lit, frames->dark);
    if (!stripe) return tl::unexpected(stripe.error());
    TargetPicture picture{placement, angle, std::move(*view), {}};
    for (const StripePoint& point : *stripe) {
      if (!(point.flags & kSecond))
        picture.stripe.push_back({point.u, static_cast<double>(point.row)});
    }
    pictures_.push_back(std::move(picture));
    return true;
  }

  LiveScanner& scanner_;
  const CharucoTarget& target_;
  const TargetPictureOptions& options_;
  std::vector<TargetPicture> pictures_;
  std::optional<Error> why_unseen_;
};

// Renumbers the placements without gaps. A placement that no picture shows gets no number.
void close_gaps(std::vector<TargetPicture>& pictures) {
  int number = -1, last = -1;
  for (TargetPicture& picture : pictures) {
    if (picture.placement != last) last = picture.placement, ++number;
    picture.placement = number;
  }
}

}  // namespace

Expected<CalibrationInput> picture_target(const Scanner& scanner, const CharucoTarget& target,
                                          const PlaceTarget& place, EmergencyStop& stop,
                                          const TargetPictureOptions& options) {
  if (auto known = check_target(target); !known) return tl::unexpected(known.error());
  auto live = LiveScanner::open(scanner.devices, scanner.settings, stop);
  if (!live) return tl::unexpected(live.error());
  if (auto found = live->find_position(0); !found) return tl::unexpected(found.error());
  Photographer photographer(*live, target, options);
  for (int number = 0;; ++number) {
    if (auto turned = live->turn_to(0); !turned) return tl::unexpected(turned.error());
    if (auto rested = live->rest(); !rested) return tl::unexpected(rested.error());
    const auto placed = place(number);
    if (!placed) return tl::unexpected(placed.error());
    if (!*placed) break;
    const std::size_t before = photographer.pictures().size();
    if (auto taken = photographer.take_place(number); !taken) return tl::unexpected(taken.error());
    const std::size_t pictures = photographer.pictures().size();
    if (options.progress) {
      options.progress(fmt::format(
          "{} places, {} pictures that show the target{}", number + 1, pictures,
          pictures > before ? "" : "; not at this place: " + photographer.why_unseen()->message));
    }
  }
  if (photographer.pictures().empty()) {
    const auto& why = photographer.why_unseen();
    return fail(ErrorCode::kBadInput,
                fmt::format("target never seen: {}",
                            why ? why->message : "it was never placed; put it on the table"));
  }
  close_gaps(photographer.pictures());
  return CalibrationInput{.camera = live->camera().serial,
                          .region = live->region(),
                          .target = target,
                          .pictures = std::move(photographer.pictures())};
}

}  // namespace vitrine::acquisition
