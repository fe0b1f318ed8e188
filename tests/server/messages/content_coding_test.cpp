// SPDX-License-Identifier: Apache-2.0
#include "server/messages/content_coding.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(KeptJson, CountsBothFormsOfTheDocumentThatItKeeps) {
  const auto document = make_document(std::string(10 * kLeastToCompress, '1'));
  ASSERT_FALSE(document->gzip.empty());
  for (const char* coding : {"identity", "gzip"}) {
    RequestHeader request;
    request.set("Accept-Encoding", coding);
    const Response response = kept_json(request, document);
    EXPECT_EQ(body_memory(response.body), document->text.size() + document->gzip.size()) << coding;
  }
}

}  // namespace
}  // namespace vitrine::server
