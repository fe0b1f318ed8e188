// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "codec/render/png_file.h"
#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/published.h"
#include "server/http/scanner_of.h"

namespace vitrine {
namespace {

constexpr double kFarthest = 360 * 100;  // degrees, of one jog

Response state_of(ScannerStation& scanner) {
  return json_answer(scanner_json(scanner.status()));
}

// The scanner after a command, or why the command was not obeyed: that a device is gone, too, is
// for the operator to know.
Response after(const Expected<void>& done, ScannerStation& scanner, const Request& request) {
  return done ? state_of(scanner) : problem(409, done.error().message, request.id);
}

// The one member that the body is to have.
const nlohmann::json* only_member(const nlohmann::json& body, const char* name) {
  const auto found = body.find(name);
  return found != body.end() && body.size() == 1 ? &*found : nullptr;
}

Picture grey_picture(const Frame& frame) {
  Picture picture{.width = static_cast<std::uint32_t>(frame.width),
                  .height = static_cast<std::uint32_t>(frame.height)};
  picture.pixels.reserve(frame.pixels.size() * 4);
  for (const std::uint8_t level : frame.pixels)
    picture.pixels.insert(picture.pixels.end(), {level, level, level, 255});
  return picture;
}

bool is_list(const nlohmann::ordered_json& answer) {
  const auto is_scanner = [](const auto& scanner) {
    return scanner.is_object() && scanner.contains("name") && scanner["name"].is_string();
  };
  const auto scanners = answer.find("scanners");
  return scanners != answer.end() && scanners->is_array() &&
         std::all_of(scanners->begin(), scanners->end(), is_scanner);
}

// A scanner whose daemon does not answer now, or where too many wait, is not gone.
void add_others(nlohmann::ordered_json& list, const Request& request, Services& services) {
  const auto others = services.scans.others();
  std::vector<Question> questions;
  questions.reserve(others.size());
  for (const auto& [address, names] : others)
    questions.push_back({address, std::string(request.path), std::string(request.query)});
  const auto answers = ask_all(questions, request, services);
  auto answer = answers.begin();
  for (const auto& [address, names] : others) {
    const nlohmann::ordered_json& told = *answer++;
    if (is_list(told)) {
      list.insert(list.end(), told["scanners"].begin(), told["scanners"].end());
      continue;
    }
    for (const std::string& name : names)
      list.push_back(scanner_json({.name = name,
                                   .state = ScannerState::kUnreachable,
                                   .problem = "its daemon has not answered; ask again, and where "
                                              "that stays so, look at the daemon's log"}));
  }
}

}  // namespace

Response list_scanners(const Request& request, Services& services) {
  auto list = nlohmann::ordered_json::array();
  for (const ScannerStatus& scanner : services.scans.scanners()) {
    if (!elsewhere(scanner.name, request, services)) list.push_back(scanner_json(scanner));
  }
  if (!is_passed_on(request)) add_others(list, request, services);
  return json_answer({{"scanners", std::move(list)}});
}

Response show_scanner(const Request& request, Services& services) {
  return with_scanner(request, services, [](ScannerStation& scanner) { return state_of(scanner); });
}

Response jog_scanner(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto* degrees = only_member(request.body, "degrees");
    const bool fits =
        degrees != nullptr && degrees->is_number() && std::abs(degrees->get<double>()) <= kFarthest;
    if (!fits) {
      return problem(422, "say how far to turn", request.id,
                     {{"degrees", "a number from -36000 to 36000, and nothing else"}});
    }
    return after(scanner.jog(degrees->get<double>()), scanner, request);
  });
}

Response switch_laser(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto* on = only_member(request.body, "on");
    if (on == nullptr || !on->is_boolean()) {
      return problem(422, "say whether it is to be on", request.id,
                     {{"on", "true or false, and nothing else"}});
    }
    return after(scanner.laser(on->get<bool>()), scanner, request);
  });
}

// Its body is not even read: nobody who presses this button is to be taught.
Response stop_scanner(const Request& request, Services& services) {
  return with_scanner(request, services, [](ScannerStation& scanner) {
    scanner.stop();
    return state_of(scanner);
  });
}

Response show_preview(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto frame = services.scans.picture(scanner);
    if (!frame) return problem(409, frame.error().message, request.id);
    auto png = write_png(grey_picture(*frame));
    if (!png) return internal_error(png.error(), request, services);
    Response response;
    response.type = "image/png";
    response.body = std::string(png->begin(), png->end());
    return response;
  });
}

}  // namespace vitrine
