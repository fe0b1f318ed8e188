// SPDX-License-Identifier: Apache-2.0
#include "server/records/citation.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "server/messages/timestamp.h"

namespace vitrine::server {
namespace {

using Names = std::vector<std::string>;

// Returns the names as "A, B, and C". `pair` separates two names; `last` stands before the last of
// three or more names.
std::string all_names(const Names& names, std::string_view pair, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_last = i + 1 == names.size();
    if (i > 0) text += !is_last ? ", " : names.size() == 2 ? pair : last;
    text += names[i];
  }
  return text;
}

std::string mla_names(const Names& names) {
  return names.size() > 2 ? names[0] + ", et al" : all_names(names, ", and ", "");
}

// Returns the text as a sentence with a space after it, or an empty text.
std::string sentence(std::string text) {
  if (text.empty()) return text;
  const bool has_end = std::string_view(".?!").find(text.back()) != std::string_view::npos;
  return text + (has_end ? " " : ". ");
}

std::string date_of(const DescribedModel& model) {
  const std::string& date = model.text("date");
  return date.empty() ? utc_time(model.record().created / 1000).substr(0, 4) : date;
}

}  // namespace

Citations citations_of(const DescribedModel& model) {
  const Names names = values_in(model.text("creator"));
  const std::string title = model.title(), date = date_of(model), provider = model.provider(),
                    url = model.permanent_url();
  const std::string work = title + " [3D model]. ", year = fmt::format("({}). ", date);
  const std::string authors = sentence(all_names(names, ", & ", ", & "));
  Citations all;
  all.apa = (authors.empty() ? work + year : authors + year + work) + sentence(provider) + url;
  all.chicago = sentence(all_names(names, " and ", ", and ")) + sentence(title) + sentence(date) +
                "3D model. " + sentence(provider) + url + ".";
  all.mla = sentence(mla_names(names)) + sentence(title) +
            fmt::format("{}, {}, {}. 3D model.", date, provider, url);
  return all;
}

}  // namespace vitrine::server
