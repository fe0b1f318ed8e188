// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/notes.h"

#include <regex>
#include <set>

#include "server/metadata/members.h"

namespace vitrine::server {
namespace {

using CheckMembers = void (*)(const JsonMembers& members);

bool is_text(const nlohmann::json& value, std::size_t most) {
  const auto* text = value.get_ptr<const std::string*>();
  return text != nullptr && text->size() <= most;
}

// Whether the whole text matches. The text must be short, because std::regex recurses.
bool has_form(const nlohmann::json& value, const char* pattern) {
  constexpr std::size_t kShort = 40;
  return is_text(value, kShort) &&
         std::regex_match(value.get_ref<const std::string&>(), std::regex(pattern));
}

// Whether the text is the URL of a picture or sound: HTTPS, HTTP, or a path on this server.
bool is_media_url(const nlohmann::json& value) {
  if (!is_text(value, kMaxNoteUrl)) return false;
  const std::string& url = value.get_ref<const std::string&>();
  const bool is_path = url.starts_with('/') && !url.starts_with("//");
  const bool has_host = url.starts_with("https://") || url.starts_with("http://");
  return (is_path || has_host) && std::ranges::none_of(url, [](unsigned char c) {
           return c <= ' ' || c == '"' || c == '\\' || c == 0x7F;
         });
}

void check_id(const JsonMembers& members, const char* name) {
  const auto* id = members.find(name);
  if (id == nullptr || !has_form(*id, "[a-z0-9]{1,32}"))
    members.wrong(name, "1 to 32 letters from a to z and digits");
}

void check_form(const JsonMembers& members, const char* name, const char* pattern,
                const char* expected) {
  const auto* value = members.find(name);
  if (value != nullptr && !has_form(*value, pattern)) members.wrong(name, expected);
}

void check_url(const JsonMembers& members, const char* name) {
  const auto* value = members.find(name);
  if (value != nullptr && !is_media_url(*value))
    members.wrong(name, "a URL that begins with https://, http:// or /");
}

void check_text(const JsonMembers& members, const char* name, std::size_t most) {
  const auto* value = members.find(name);
  if (value != nullptr && !is_text(*value, most))
    members.wrong(name, fmt::format("a text of at most {} bytes", most));
}

void check_title(const JsonMembers& members, const char* name) {
  const auto* title = members.find(name);
  if (title == nullptr || !is_text(*title, kMaxNoteTitle) ||
      title->get_ref<const std::string&>().empty())
    members.wrong(name, fmt::format("a text of 1 to {} bytes", kMaxNoteTitle));
}

void check_point(const JsonMembers& members, const char* name, bool is_required) {
  const auto* value = members.find(name);
  if (value == nullptr ? is_required : !json_point(*value))
    members.wrong(name, "three numbers x, y, z");
}

// Checks an object whose names are languages (BCP 47). Calls `check(members, language)` for each.
template <class Check>
void check_languages(const JsonMembers& members, const char* name, const Check& check) {
  const auto* value = members.find(name);
  const bool has_size =
      value != nullptr && value->is_object() && !value->empty() && value->size() <= kMostLanguages;
  if (!has_size)
    return members.wrong(name, fmt::format("an object with 1 to {} languages", kMostLanguages));
  const JsonMembers languages = members.within(name);
  for (const auto& [language, text] : value->items()) {
    if (!has_form(language, "[A-Za-z]{2,3}(-[A-Za-z0-9]{2,8}){0,3}"))
      languages.wrong(language.c_str(), "a language tag such as en or de-AT");
    check(languages, language.c_str());
  }
}

void check_view(const JsonMembers& view) {
  view.only({"direction", "target", "zoom"});
  check_point(view, "direction", true);
  check_point(view, "target", false);
  double zoom = 1;
  view.real("zoom", 0.1, 100, 1, zoom);
}

void check_note_text(const JsonMembers& text) {
  text.only({"title", "text", "alt", "audio"});
  check_title(text, "title");
  check_text(text, "text", kMaxNoteText);
  check_text(text, "alt", kMaxNoteText);
  check_url(text, "audio");
}

void check_object(const JsonMembers& members, const char* name, CheckMembers check) {
  const auto* value = members.find(name);
  if (value == nullptr) return;
  if (!value->is_object()) return members.wrong(name, "an object");
  check(members.within(name));
}

void check_note(const JsonMembers& note) {
  note.only({"id", "position", "normal", "texts", "picture", "view", "light", "section"});
  check_id(note, "id");
  check_point(note, "position", true);
  check_point(note, "normal", false);
  check_languages(note, "texts", [](const JsonMembers& texts, const char* language) {
    check_object(texts, language, check_note_text);
  });
  check_url(note, "picture");
  check_object(note, "view", check_view);
  check_form(note, "light", "museum|studio|relief|raking,[0-9]{1,3}",
             "museum, studio, relief, or raking with an angle, such as raking,315");
  check_form(note, "section", "|[xyz],[0-9]{1,3}(,flip)?",
             "a direction and a percentage, such as y,50 or y,50,flip; empty for none");
}

void check_step(const JsonMembers& step) {
  step.only({"note", "seconds", "transition"});
  check_id(step, "note");
  double seconds = 0;
  step.real("seconds", 1, 600, 0, seconds);
  check_form(step, "transition", "fly|cut", "fly or cut");
}

// Checks a list of objects. Their IDs must be different if `has_ids`.
void check_list(const nlohmann::json& list, std::size_t most, const std::string& name, bool has_ids,
                const WrongField& wrong, CheckMembers check) {
  if (!list.is_array() || list.size() > most)
    return wrong(name, fmt::format("a list with at most {} entries", most));
  std::set<std::string> ids;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string at = fmt::format("{}{}{}", name, name.empty() ? "" : ".", i);
    if (!list[i].is_object()) {
      wrong(at, "an object");
      continue;
    }
    const JsonMembers members(list[i], at + '.', wrong);
    check(members);
    const auto* id = members.find("id");
    if (has_ids && id != nullptr && id->is_string() && !ids.insert(id->get<std::string>()).second)
      members.wrong("id", "an ID that no other entry has");
  }
}

void check_tour(const JsonMembers& tour) {
  tour.only({"id", "titles", "steps"});
  check_id(tour, "id");
  check_languages(tour, "titles", check_title);
  const auto* steps = tour.find("steps");
  if (steps == nullptr) return tour.wrong("steps", "a list of steps");
  check_list(*steps, kMostSteps, tour.name_of("steps"), false, tour.faults(), check_step);
}

}  // namespace

void check_notes(const nlohmann::json& notes, const WrongField& wrong) {
  check_list(notes, kMostNotes, "", true, wrong, check_note);
}

void check_tours(const nlohmann::json& tours, const WrongField& wrong) {
  check_list(tours, kMostTours, "", true, wrong, check_tour);
}

}  // namespace vitrine::server
