// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/notes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace vitrine::server {
namespace {

using nlohmann::json;
using WrongNames = std::vector<std::string>;

const json kNote = {
    {"id", "ear"},
    {"position", {1, 2.5, -3}},
    {"normal", {0, 0, 1}},
    {"texts",
     {{"en",
       {{"title", "Ear"}, {"text", "One.\n\nTwo."}, {"alt", "An ear"}, {"audio", "/ear.mp3"}}},
      {"de-AT", {{"title", "Ohr"}}}}},
    {"picture", "https://museum.example/ear.jpg"},
    {"view", {{"direction", {1, 0, 0}}, {"target", {1, 2, 3}}, {"zoom", 2}}},
    {"light", "raking,45"},
    {"section", "y,200,flip"}};
const json kTour = {{"id", "tour"},
                    {"titles", {{"en", "A tour"}}},
                    {"steps", {{{"note", "ear"}, {"seconds", 8}, {"transition", "cut"}}}}};

using CheckList = void (*)(const json& list, const WrongField& wrong);

WrongNames wrong_in(CheckList check, const json& list) {
  WrongNames names;
  check(list, [&](const std::string& field, const std::string& expected) {
    EXPECT_FALSE(expected.empty()) << field;
    names.push_back(field);
  });
  return names;
}

// Returns the names of the wrong fields after `change`, a JSON merge patch, was applied to `entry`.
WrongNames wrong_after(CheckList check, json entry, const json& change) {
  entry.merge_patch(change);
  return wrong_in(check, json::array({entry}));
}

TEST(Notes, AllFieldsMayBeGivenAndMostMayBeLeftOut) {
  EXPECT_EQ(wrong_in(check_notes, json::array()), WrongNames{});
  const json least = {{"id", "a"}, {"position", {0, 0, 0}}, {"texts", {{"en", {{"title", "A"}}}}}};
  EXPECT_EQ(wrong_in(check_notes, json::array({kNote, least})), WrongNames{});
  EXPECT_EQ(wrong_in(check_tours, json::array({kTour})), WrongNames{});
  EXPECT_EQ(wrong_after(check_notes, kNote, {{"section", ""}, {"light", "museum"}}), WrongNames{});
  EXPECT_EQ(wrong_after(check_notes, kNote, {{"section", "x,0"}, {"light", "raking,360"}}),
            WrongNames{});
}

TEST(Notes, PicturesAndSoundsComeFromThisServerOrByHttps) {
  for (const char* url :
       {"/a.png", "https://a", "https://a.example:8443/b.png?c#d", "https://[::1]/"})
    EXPECT_EQ(wrong_after(check_notes, kNote, {{"picture", url}}), WrongNames{}) << url;
  for (const char* url :
       {"", "a.png", "http://a.example/b.png", "HTTPS://a", "//a.example/b.png", "https://",
        "https:///b.png", "https://?a", "https://#a", "https://:443/b.png", "https://a@/b.png",
        "https://a/ b.png", "https://a/\nb", "https://a/\xc2\x9b", "https://a\\b",
        "https://a/\" onerror", "data:image/png;base64,AA"}) {
    EXPECT_EQ(wrong_after(check_notes, kNote, {{"picture", url}}), WrongNames{"0.picture"}) << url;
  }
}

TEST(Notes, NoNumberIsNull) {
  // A merge patch cannot set a null.
  json note = kNote, tour = kTour;
  note["view"]["zoom"] = nullptr;
  EXPECT_EQ(wrong_in(check_notes, json::array({note})), WrongNames{"0.view.zoom"});
  tour["steps"][0]["seconds"] = nullptr;
  EXPECT_EQ(wrong_in(check_tours, json::array({tour})), WrongNames{"0.steps.0.seconds"});
}

TEST(Notes, EachWrongFieldIsNamed) {
  const std::pair<json, std::string> cases[] = {
      {{{"id", "Ear"}}, "0.id"},
      {{{"id", nullptr}}, "0.id"},
      {{{"position", {1, 2}}}, "0.position"},
      {{{"position", nullptr}}, "0.position"},
      {{{"position", {1, 2, 1e300}}}, "0.position"},
      {{{"normal", "up"}}, "0.normal"},
      {{{"normal", {0, 0, 0}}}, "0.normal"},
      {{{"colour", "red"}}, "0.colour"},
      {{{"texts", nullptr}}, "0.texts"},
      {{{"texts", json::array()}}, "0.texts"},
      {{{"texts", {{"english", {{"title", "A"}}}}}}, "0.texts.english"},
      {{{"texts", {{"en", 3}}}}, "0.texts.en"},
      {{{"texts", {{"en", {{"title", ""}}}}}}, "0.texts.en.title"},
      {{{"texts", {{"en", {{"title", std::string(201, 'a')}}}}}}, "0.texts.en.title"},
      {{{"texts", {{"en", {{"title", "a\nb"}}}}}}, "0.texts.en.title"},
      {{{"texts", {{"en", {{"title", "\x1b[2J"}}}}}}, "0.texts.en.title"},
      {{{"texts", {{"en", {{"text", std::string(8001, 'a')}}}}}}, "0.texts.en.text"},
      {{{"texts", {{"en", {{"text", std::string("a\0b", 3)}}}}}}, "0.texts.en.text"},
      {{{"texts", {{"en", {{"alt", "a\tb"}}}}}}, "0.texts.en.alt"},
      {{{"texts", {{"en", {{"html", "<b>"}}}}}}, "0.texts.en.html"},
      {{{"texts", {{"en", {{"audio", "javascript:alert(1)"}}}}}}, "0.texts.en.audio"},
      {{{"view", 3}}, "0.view"},
      {{{"view", {{"direction", nullptr}}}}, "0.view.direction"},
      {{{"view", {{"direction", {0, 0, 0}}}}}, "0.view.direction"},
      {{{"view", {{"zoom", 0}}}}, "0.view.zoom"},
      {{{"light", "disco"}}, "0.light"},
      {{{"light", "raking,361"}}, "0.light"},
      {{{"light", "raking,999"}}, "0.light"},
      {{{"section", "w,3"}}, "0.section"},
      {{{"section", "x,201"}}, "0.section"},
      {{{"section", "x,999"}}, "0.section"}};
  for (const auto& [change, field] : cases)
    EXPECT_EQ(wrong_after(check_notes, kNote, change), WrongNames{field}) << change;
  EXPECT_EQ(wrong_in(check_notes, json::object()), WrongNames{""});
  EXPECT_EQ(wrong_in(check_notes, json::array({kNote, 3})), WrongNames{"1"});
}

TEST(Notes, EachWrongFieldOfATourIsNamed) {
  const std::pair<json, std::string> cases[] = {
      {{{"titles", {{"en", 3}}}}, "0.titles.en"},
      {{{"titles", {{"en", "a\nb"}}}}, "0.titles.en"},
      {{{"steps", nullptr}}, "0.steps"},
      {{{"steps", {3}}}, "0.steps.0"},
      {{{"steps", {{{"note", "a b"}}}}}, "0.steps.0.note"},
      {{{"steps", {{{"note", "a"}, {"seconds", 0}}}}}, "0.steps.0.seconds"},
      {{{"steps", {{{"note", "a"}, {"transition", "jump"}}}}}, "0.steps.0.transition"}};
  for (const auto& [change, field] : cases)
    EXPECT_EQ(wrong_after(check_tours, kTour, change), WrongNames{field}) << change;
}

TEST(Notes, CountsAreBoundedAndIdsAreUnique) {
  json notes = json::array();
  for (std::size_t i = 0; i < kMostNotes; ++i) {
    notes.push_back(kNote);
    notes.back()["id"] = "n" + std::to_string(i);
  }
  EXPECT_EQ(wrong_in(check_notes, notes), WrongNames{});
  notes.push_back(kNote);
  EXPECT_EQ(wrong_in(check_notes, notes), WrongNames{""});
  EXPECT_EQ(wrong_in(check_notes, json::array({kNote, kNote})), WrongNames{"1.id"});
  json tour = kTour;
  tour["steps"] = json(kMostSteps + 1, kTour["steps"][0]);
  EXPECT_EQ(wrong_in(check_tours, json::array({tour})), WrongNames{"0.steps"});
}

}  // namespace
}  // namespace vitrine::server
