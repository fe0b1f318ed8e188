// SPDX-License-Identifier: Apache-2.0
// Writes the golden files into a folder. Usage: golden_writer FOLDER.
#include <cstdio>
#include <fstream>

#include "golden/golden_models.h"

int main(int argc, char** argv) {
  if (argc != 2) return std::puts("Usage: golden_writer FOLDER"), 2;
  const std::string folder = argv[1];
  for (const auto& golden : vitrine::test::golden_models()) {
    const auto model = vitrine::test::stored(golden);
    std::ofstream pmesh(folder + "/" + golden.name + ".pmesh", std::ios::binary);
    pmesh.write(reinterpret_cast<const char*>(model.file.data()),
                static_cast<std::streamsize>(model.file.size()));
    std::ofstream text(folder + "/" + golden.name + ".levels");
    text << vitrine::test::level_digests(model.file);
    if (!pmesh.flush() || !text.flush()) return std::puts("cannot write there"), 1;
  }
  return 0;
}
