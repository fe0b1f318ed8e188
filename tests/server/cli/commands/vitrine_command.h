// SPDX-License-Identifier: Apache-2.0
// A fixture that runs the real program in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "support/process/run_program.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

// Returns a bumpy torus of about `faces` faces as an ASCII PLY.
std::string bumpy_ply(int faces, bool open = false, bool coloured = false);

inline const std::string kVitrine = VITRINE_BIN_DIR "/vitrine";

class VitrineCommand : public testing::Test {
 protected:
  const TemporaryFolder folder_;

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string write(const std::string& name, const std::string& contents) const {
    std::ofstream(path(name), std::ios::binary) << contents;
    return path(name);
  }
  // Creates an empty folder, for example for --data. Returns its path.
  std::string empty_folder(const std::string& name) const {
    std::filesystem::create_directory(path(name));
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  // Runs a command. If the command writes files, it replaces the files of an earlier call.
  static ProgramResult vitrine(std::vector<std::string> words) {
    const std::string command = words.empty() ? "" : words[0];
    if (command == "build" || command == "decode") words.insert(words.begin() + 1, "--force");
    words.insert(words.begin(), kVitrine);
    return run_program(words);
  }
  // Runs a command with --json and returns the JSON object that the command prints. The command
  // must succeed and print nothing else.
  static nlohmann::json vitrine_json(std::vector<std::string> words) {
    words.emplace_back("--json");
    const ProgramResult result = vitrine(words);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    return nlohmann::json::parse(result.output, nullptr, false);
  }
  // Builds model.pmesh from model.ply and returns its path.
  std::string model(int faces = 3'000, bool open = false, bool coloured = false) {
    const std::string in = write("model.ply", bumpy_ply(faces, open, coloured));
    vitrine_json({"build", in, "-o", path("model.pmesh")});
    return path("model.pmesh");
  }
};

// Expects one line of the form "vitrine: CAUSE; NEXT STEP", and the exit code.
inline void expect_fault(const ProgramResult& result, int exit_code) {
  static const std::regex kForm("vitrine: [^;\n]+[^;\n ]; [^;\n]+\n");
  EXPECT_EQ(result.exit_code, exit_code) << result.errors;
  EXPECT_TRUE(std::regex_match(result.errors, kForm)) << result.errors;
}

}  // namespace vitrine::test
