// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "codec/picture/write_picture.h"
#include "server/api/forward.h"
#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/published.h"

namespace vitrine::server {
namespace {

constexpr double kFarthest = 360 * 100;  // largest angle of one jog, in degrees

Response state_of(ScannerStation& scanner) {
  return json_answer(scanner_json(scanner.status()));
}

// Returns the scanner's state if the command succeeded. Otherwise returns 409 with the reason, even
// if the reason is a device's error, because the operator must see it.
Response after(const Expected<void>& done, ScannerStation& scanner, const Request& request) {
  return done ? state_of(scanner) : problem(409, done.error().message, request.id);
}

// Returns the member `name` of the body. Returns null if it is absent or not the only member.
const nlohmann::json* only_member(const nlohmann::json& body, const char* name) {
  const auto found = body.find(name);
  return found != body.end() && body.size() == 1 ? &*found : nullptr;
}

// Returns a permit for the laser. The permit ends when the caller's token is revoked or cannot be
// checked.
LaserPermit permit_of(const Caller& caller, Authenticator& tokens) {
  return [caller, &tokens] { return tokens.is_in_force(caller).value_or(false); };
}

Picture grey_picture(const acquisition::Frame& frame) {
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

// Adds the scanners of other daemons to the list. If a daemon does not respond in time or too many
// requests are being forwarded, its scanners are listed as unreachable.
void add_others(nlohmann::ordered_json& list, const Request& request, Services& services) {
  const auto others = services.scans.others();
  std::vector<DaemonQuery> questions;
  questions.reserve(others.size());
  for (const auto& [address, names] : others)
    questions.push_back({address, std::string(request.path), std::string(request.query)});
  const auto answers = ask_daemons(questions, request, services);
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
                                   .problem = "its daemon has not responded; try again, and if "
                                              "that does not help, see the daemon's log"}));
  }
}

}  // namespace

static Response list_scanners(const Request& request, Services& services) {
  auto list = nlohmann::ordered_json::array();
  for (const ScannerStatus& scanner : services.scans.scanners()) {
    if (!forward_address(scanner.name, request, services)) list.push_back(scanner_json(scanner));
  }
  if (!is_forwarded(request)) add_others(list, request, services);
  return json_answer({{"scanners", std::move(list)}});
}

static Response show_scanner(const Request& request, Services& services) {
  return with_scanner(request, services, [](ScannerStation& scanner) { return state_of(scanner); });
}

static Response jog_scanner(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto* degrees = only_member(request.body, "degrees");
    const bool fits =
        degrees != nullptr && degrees->is_number() && std::abs(degrees->get<double>()) <= kFarthest;
    if (!fits) {
      return problem(422, "give the angle to turn", request.id,
                     {{"degrees", "a number from -36000 to 36000, and nothing else"}});
    }
    return after(scanner.jog(degrees->get<double>()), scanner, request);
  });
}

static Response switch_laser(const Request& request, Services& services) {
  return with_scanner(request, services, [&](ScannerStation& scanner) {
    const auto* on = only_member(request.body, "on");
    if (on == nullptr || !on->is_boolean()) {
      return problem(422, "give the state of the laser", request.id,
                     {{"on", "true or false, and nothing else"}});
    }
    const auto done = on->get<bool>()
                          ? scanner.switch_laser_on(permit_of(*request.caller, services.tokens))
                          : scanner.switch_laser_off();
    return after(done, scanner, request);
  });
}

// Does not read the request body: an emergency stop must not fail because of a malformed body.
static Response stop_scanner(const Request& request, Services& services) {
  return with_scanner(request, services, [](ScannerStation& scanner) {
    scanner.stop();
    return state_of(scanner);
  });
}

static Response show_preview(const Request& request, Services& services) {
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

static constexpr std::string_view kScannersComponents = R"json({
"schemas": {
  "Scanner": {"type": "object", "required": ["id", "name", "state", "camera", "board", "calibration", "scan", "problem", "laser", "motor"], "properties": {
    "id": {"type": "string"}, "name": {"type": "string"}, "state": {"enum": ["idle", "busy", "unreachable"]},
    "camera": {"type": ["object", "null"], "properties": {"vendor": {"type": "string"}, "model": {"type": "string"}, "serial": {"type": "string"}}},
    "board": {"type": ["object", "null"], "properties": {"dialect": {"type": "string"}, "firmware": {"type": "string"}}},
    "calibration": {"type": ["integer", "null"]}, "scan": {"$ref": "#/components/schemas/IdOrNull"},
    "problem": {"type": ["string", "null"], "description": "The fault that keeps the scanner from working, and its remedy"},
    "laser": {"type": "object", "required": ["state", "since"], "description": "unknown: the board has not confirmed that the laser is off, or its daemon does not respond",
      "properties": {"state": {"enum": ["unknown", "off", "on"]}, "since": {"$ref": "#/components/schemas/Since"}}},
    "motor": {"type": "object", "required": ["state", "since"], "description": "holding: the motor has power and holds the table still",
      "properties": {"state": {"enum": ["unknown", "off", "holding", "turning"]}, "since": {"$ref": "#/components/schemas/Since"}}}}},
  "Since": {"type": ["string", "null"], "format": "date-time", "description": "Time of the last change of the state; null if the state was never known"},
  "ScannerList": {"type": "object", "required": ["scanners"], "properties": {
    "scanners": {"type": "array", "items": {"$ref": "#/components/schemas/Scanner"}}}},
  "Jog": {"type": "object", "required": ["degrees"], "additionalProperties": false, "properties": {
    "degrees": {"type": "number", "minimum": -36000, "maximum": 36000}}},
  "LaserSwitch": {"type": "object", "required": ["on"], "additionalProperties": false, "properties": {"on": {"type": "boolean"}}}
}
})json";

static constexpr ApiRoute kScannerRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/scanners",
     .handler = list_scanners,
     .executor = Executor::kDevice,
     .role = Role::kViewer,
     .doc = {.id = "listScanners",
             .summary = "Lists the scanners and their devices, including scanners whose daemon "
                        "does not respond.",
             .response = "ScannerList"}},
    {.method = Method::kGet,
     .path = "/api/v1/scanners/{name}",
     .handler = show_scanner,
     .executor = Executor::kDevice,
     .role = Role::kViewer,
     .doc = {.id = "getScanner",
             .summary =
                 "Returns a scanner's state and devices, and the state of its laser and motor.",
             .response = "Scanner"}},
    {.method = Method::kPost,
     .path = "/api/v1/scanners/{name}/jog",
     .handler = jog_scanner,
     .executor = Executor::kDevice,
     .role = Role::kOperator,
     .doc = {.id = "jogScanner",
             .summary = "Rotates the turntable by an angle.",
             .request = "Jog",
             .response = "Scanner"}},
    {.method = Method::kPost,
     .path = "/api/v1/scanners/{name}/laser",
     .handler = switch_laser,
     .executor = Executor::kDevice,
     .role = Role::kOperator,
     .doc = {.id = "switchLaser",
             .summary =
                 "Switches the laser on or off. A laser that was switched on goes off after 60 "
                 "seconds, when the token is revoked, when the table is turned by hand, and "
                 "when a job begins.",
             .request = "LaserSwitch",
             .response = "Scanner"}},
    {.method = Method::kPost,
     .path = "/api/v1/scanners/{name}/stop",
     .handler = stop_scanner,
     .executor = Executor::kUrgent,
     .role = Role::kOperator,
     .body = BodyKind::kPieces,
     .doc = {.id = "stopScanner",
             .summary = "Emergency stop: switches laser and motor off at once. The request body "
                        "is ignored.",
             .response = "Scanner"}},
    {.method = Method::kGet,
     .path = "/api/v1/scanners/{name}/preview",
     .handler = show_preview,
     .executor = Executor::kDevice,
     .role = Role::kOperator,
     .doc = {.id = "getPreview",
             .summary = "Returns the camera's current picture.",
             .response = "image/png"}},
};

static constexpr ApiTag kScannersTags[] = {
    {.name = "scanners",
     .description = "Scanners of this daemon: state, previews, calibration and emergency stop."}};

const ApiNoun kScanners = {
    .routes = kScannerRoutes, .components = kScannersComponents, .tags = kScannersTags};

}  // namespace vitrine::server
