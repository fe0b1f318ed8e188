// SPDX-License-Identifier: Apache-2.0
// Validates XML documents with xmllint: against the schemas in tests/server/records/schemas, and
// against the published XML schemas if the environment variable VITRINE_RECORD_SCHEMAS names a
// folder with all of them: OAI-PMH.xsd, oai_dc.xsd, EDM.xsd and lido-v1.1.xsd.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "support/process/run_program.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

// Returns a schema that consists of the published ones in `folder`. A response of OAI-PMH needs
// several of them.
inline std::string published_schemas(const std::string& folder) {
  constexpr std::pair<const char*, const char*> kSchemas[] = {
      {"http://www.openarchives.org/OAI/2.0/", "OAI-PMH.xsd"},
      {"http://www.openarchives.org/OAI/2.0/oai_dc/", "oai_dc.xsd"},
      {"http://www.w3.org/1999/02/22-rdf-syntax-ns#", "EDM.xsd"},
      {"http://www.lido-schema.org", "lido-v1.1.xsd"}};
  std::string text = "<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">";
  for (const auto& [xml_namespace, file] : kSchemas) {
    text += fmt::format("<xs:import namespace=\"{}\" schemaLocation=\"{}/{}\"/>", xml_namespace,
                        folder, file);
  }
  return text + "</xs:schema>";
}

// Expects that `xml` is valid. `own`: name of a schema in tests/server/records/schemas.
inline void expect_valid(const std::string& xml, const std::string& own) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "document.xml", all = folder.path() / "published.xsd";
  std::ofstream(file) << xml;
  const auto check = [&](const char* kind, const std::string& schema) {
    const auto result = run_program({"xmllint", "--nonet", "--noout", kind, schema, file});
    EXPECT_EQ(result.exit_code, 0) << schema << '\n' << result.errors << xml;
  };
  check("--relaxng", VITRINE_SOURCE_DIR "/tests/server/records/schemas/" + own);
  const char* const schemas = std::getenv("VITRINE_RECORD_SCHEMAS");
  if (schemas == nullptr) return;
  std::ofstream(all) << published_schemas(schemas);
  check("--schema", all);
}

}  // namespace vitrine::test
