// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/notes.h"

#include <regex>
#include <set>

#include "server/metadata/members.h"
#include "server/metadata/text.h"

namespace vitrine::server {
namespace {

using CheckMembers = void (*)(const JsonMembers& members);

// The functions below return the patterns of short texts. Each pattern is compiled once, because
// std::regex compiles slowly.
const std::regex& id_form() {
  static const std::regex form("[a-z0-9]{1,32}");
  return form;
}

const std::regex& language_form() {
  static const std::regex form("[A-Za-z]{2,3}(-[A-Za-z0-9]{2,8}){0,3}");
  return form;
}

const std::regex& light_form() {
  static const std::regex form("museum|studio|relief|raking,(360|3[0-5][0-9]|[12]?[0-9]{1,2})");
  return form;
}

const std::regex& section_form() {
  static const std::regex form("|[xyz],(200|1?[0-9]{1,2})(,flip)?");
  return form;
}

const std::regex& transition_form() {
  static const std::regex form("fly|cut");
  return form;
}

// Returns the text of `value`, or nullptr if it is no text or larger than `most` bytes.
const std::string* text_in(const nlohmann::json& value, std::size_t most) {
  const auto* text = value.get_ptr<const std::string*>();
  return text != nullptr && text->size() <= most ? text : nullptr;
}

// Whether the whole text matches. The text must be short, because std::regex recurses.
bool has_form(const nlohmann::json& value, const std::regex& form) {
  constexpr std::size_t kShort = 40;
  const std::string* text = text_in(value, kShort);
  return text != nullptr && std::regex_match(*text, form);
}

// Whether a URL without its scheme begins with a host.
bool has_host(std::string_view rest) {
  const std::string_view authority = rest.substr(0, rest.find_first_of("/?#"));
  const std::string_view host = authority.substr(authority.rfind('@') + 1);  // npos + 1 is 0
  return !host.empty() && host.front() != ':';
}

// Whether the text is the URL of a picture or sound. The content security policy of the daemon's
// pages allows only HTTPS and the daemon itself.
bool is_media_url(const nlohmann::json& value) {
  constexpr std::string_view kHttps = "https://";
  const std::string* url = text_in(value, kMaxNoteUrl);
  if (url == nullptr || !is_plain_text(*url) || url->find_first_of(" \"\\") != url->npos)
    return false;
  const bool is_path = url->starts_with('/') && !url->starts_with("//");
  return is_path ||
         (url->starts_with(kHttps) && has_host(std::string_view(*url).substr(kHttps.size())));
}

void check_id(const JsonMembers& members, const char* name) {
  const auto* id = members.find(name);
  if (id == nullptr || !has_form(*id, id_form()))
    members.wrong(name, "1 to 32 letters from a to z and digits");
}

void check_form(const JsonMembers& members, const char* name, const std::regex& form,
                const char* expected) {
  const auto* value = members.find(name);
  if (value != nullptr && !has_form(*value, form)) members.wrong(name, expected);
}

void check_url(const JsonMembers& members, const char* name) {
  const auto* value = members.find(name);
  if (value != nullptr && !is_media_url(*value))
    members.wrong(
        name,
        "a URL that begins with https:// and a host, or a path on this server that begins with /");
}

void check_text(const JsonMembers& members, const char* name) {
  const auto* value = members.find(name);
  if (value == nullptr) return;
  const std::string* text = text_in(*value, kMaxNoteText);
  if (text == nullptr || !is_paragraphs(*text))
    members.wrong(
        name, fmt::format("plain text of at most {} bytes; line feeds are allowed", kMaxNoteText));
}

void check_title(const JsonMembers& members, const char* name) {
  const auto* value = members.find(name);
  const std::string* title = value == nullptr ? nullptr : text_in(*value, kMaxNoteTitle);
  if (title == nullptr || title->empty() || !is_plain_text(*title))
    members.wrong(name, fmt::format("one line of plain text of 1 to {} bytes", kMaxNoteTitle));
}

void check_number(const JsonMembers& members, const char* name, double low, double high) {
  const auto* value = members.find(name);
  const bool is_right = value == nullptr || (value->is_number() && *value >= low && *value <= high);
  if (!is_right) members.wrong(name, fmt::format("a number from {} to {}", low, high));
}

void check_point(const JsonMembers& members, const char* name, bool is_required) {
  const auto* value = members.find(name);
  if (value == nullptr ? is_required : !json_point(*value))
    members.wrong(name, "three numbers x, y, z");
}

void check_direction(const JsonMembers& members, const char* name, bool is_required) {
  const auto* value = members.find(name);
  if (value == nullptr && !is_required) return;
  const auto direction = value == nullptr ? std::nullopt : json_point(*value);
  if (!direction || !(dot(*direction, *direction) > 0))
    members.wrong(name, "three numbers x, y, z that are not all 0");
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
    if (!has_form(language, language_form()))
      languages.wrong(language.c_str(), "a language tag such as en or de-AT");
    check(languages, language.c_str());
  }
}

void check_view(const JsonMembers& view) {
  view.only({"direction", "target", "zoom"});
  check_direction(view, "direction", true);
  check_point(view, "target", false);
  check_number(view, "zoom", 0.1, 100);
}

void check_note_text(const JsonMembers& text) {
  text.only({"title", "text", "alt", "audio"});
  check_title(text, "title");
  check_text(text, "text");
  check_text(text, "alt");
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
  check_direction(note, "normal", false);
  check_languages(note, "texts", [](const JsonMembers& texts, const char* language) {
    check_object(texts, language, check_note_text);
  });
  check_url(note, "picture");
  check_object(note, "view", check_view);
  check_form(note, "light", light_form(),
             "museum, studio, relief, or raking with an angle from 0 to 360, such as raking,315");
  check_form(note, "section", section_form(),
             "an axis and a position from 0 to 200, such as y,100 or y,100,flip; empty for none");
}

void check_step(const JsonMembers& step) {
  step.only({"note", "seconds", "transition"});
  check_id(step, "note");
  check_number(step, "seconds", 1, 600);
  check_form(step, "transition", transition_form(), "fly or cut");
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
