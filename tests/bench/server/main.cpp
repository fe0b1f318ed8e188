// SPDX-License-Identifier: Apache-2.0
// bench-server: compares the daemon with similar programs on the loopback interface. The exit code
// is 0 only if every ratio is within its threshold.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "sections.h"
#include "support/product_names.h"

namespace vitrine::bench {
namespace {

struct Section {
  std::string_view name;
  void (*run)(Report& report, const Effort& effort);
};
constexpr Section kSections[] = {
    {"throughput", throughput}, {"scale", scale},         {"first_triangle", first_triangle},
    {"adaptation", adaptation}, {"half_open", half_open}, {"soak", soak},
    {"replicas", replicas},
};

int usage(int code) {
  std::string text = "Usage: bench-server [--quick] [--json] [SECTION]...\nsections:";
  for (const Section& section : kSections)
    text.append(" ").append(section.name);
  std::fprintf(code == 0 ? stdout : stderr, "%s\n", text.c_str());
  return code;
}

int run(const std::vector<std::string_view>& arguments) {
  bool json = false;
  Effort effort;
  std::vector<std::string_view> wanted;
  for (const std::string_view argument : arguments) {
    if (argument == "--json") {
      json = true;
    } else if (argument == "--quick") {
      effort.is_quick = true;
    } else if (std::ranges::find(kSections, argument, &Section::name) != std::end(kSections)) {
      wanted.push_back(argument);
    } else {
      return usage(argument == "--help" ? 0 : 2);
    }
  }
  Report report(json);
  for (const Section& section : kSections) {
    if (wanted.empty() || std::ranges::find(wanted, section.name) != wanted.end())
      section.run(report, effort);
  }
  return report.finish() ? 0 : 1;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  try {
    return vitrine::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench-server: %s\n", error.what());
    return 1;
  }
}
