// SPDX-License-Identifier: Apache-2.0
#include "server/messages/problem_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "codec/core/html.h"

namespace vitrine::server {
namespace {

using beast::http::field;

struct PageTexts {
  std::string_view language, collection, console, request;
  std::string_view not_found, not_found_hint;
  std::string_view sign_in, sign_in_hint;
  std::string_view failed, failed_hint;
};

constexpr PageTexts kEnglish = {
    .language = "en",
    .collection = "To the collection",
    .console = "To the console",
    .request = "Request",
    .not_found = "This is not on display",
    .not_found_hint = "The object may have been withdrawn, or the address may be incomplete.",
    .sign_in = "Only for signed-in operators",
    .sign_in_hint = "Sign in at the console with an access token.",
    .failed = "This page cannot be shown",
    .failed_hint =
        "Try again in a minute. If that does not help, send the museum the request number below."};

constexpr PageTexts kGerman = {
    .language = "de",
    .collection = "Zur Sammlung",
    .console = "Zur Konsole",
    .request = "Anfrage",
    .not_found = "Das ist nicht ausgestellt",
    .not_found_hint =
        "Vielleicht wurde das Objekt zurückgezogen, oder die Adresse ist unvollständig.",
    .sign_in = "Nur für angemeldete Mitarbeiter",
    .sign_in_hint = "Bitte an der Konsole mit einem Zugangstoken anmelden.",
    .failed = "Diese Seite kann nicht gezeigt werden",
    .failed_hint =
        "Bitte in einer Minute noch einmal versuchen. Hilft das nicht, dem Museum die Nummer der "
        "Anfrage unten nennen."};

std::string_view text_of(beast::string_view view) {
  return {view.data(), view.size()};
}

// Returns the heading, the text and the link of the page.
std::string content(const PageTexts& texts, unsigned status) {
  const bool is_absent = status == 404 || status == 410;
  const bool is_locked = status == 401 || status == 403;
  const auto heading = is_absent ? texts.not_found : is_locked ? texts.sign_in : texts.failed;
  const auto hint = is_absent   ? texts.not_found_hint
                    : is_locked ? texts.sign_in_hint
                                : texts.failed_hint;
  return fmt::format("<h1>{}</h1>\n<p>{}</p>\n<p><a class=\"button\" href=\"{}\">{}</a></p>\n",
                     heading, hint, is_locked ? "/console" : "/",
                     is_locked ? texts.console : texts.collection);
}

}  // namespace

bool wants_page(const RequestHeader& request) {
  const auto method = request.method();
  if (method != beast::http::verb::get && method != beast::http::verb::head) return false;
  const std::string_view accepted = text_of(request[field::accept]);
  return accepted.find("text/html") != accepted.npos && accepted.find("json") == accepted.npos;
}

Response problem_page(Response problem, const RequestHeader& request) {
  const bool is_german = text_of(request[field::accept_language]).starts_with("de");
  const PageTexts& texts = is_german ? kGerman : kEnglish;
  const auto* body = std::get_if<std::string>(&problem.body);
  const auto json = nlohmann::json::parse(body == nullptr ? "" : *body, nullptr, false);
  const auto member = [&](const char* name) {
    return json.is_object() ? escape_html(json.value(name, "")) : std::string();
  };
  problem.body = fmt::format(
      "<!doctype html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"robots\" content=\"noindex\">\n<title>{} {}</title>\n"
      "<link rel=\"icon\" href=\"/favicon.svg\" type=\"image/svg+xml\">\n"
      "<link rel=\"stylesheet\" href=\"/site.css\">\n</head>\n<body class=\"problem\">\n<main>\n{}"
      "<p class=\"quiet\">{} {} · {} {}</p>\n</main>\n</body>\n</html>\n",
      texts.language, problem.status, member("title"), content(texts, problem.status),
      problem.status, member("title"), texts.request, member("request_id"));
  problem.type = "text/html; charset=utf-8";
  problem.fields.emplace_back("Vary", "Accept, Accept-Language");
  return problem;
}

}  // namespace vitrine::server
