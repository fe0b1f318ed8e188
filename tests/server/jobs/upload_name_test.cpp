// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/jobs/publish_jobs.h"

namespace vitrine::server {
namespace {

TEST(UploadName, IsThatOfTheKeyFilename) {
  EXPECT_EQ(upload_name("filename YS56dGw="), "a.ztl");
  EXPECT_EQ(upload_name("filetype bW9kZWw=, filename YQ=="), "a");
  EXPECT_EQ(upload_name("public,filename QsO8c3Rl,x YQ=="), "B\xC3\xBCste");
}

TEST(UploadName, IsEmptyWithoutAReadableName) {
  for (const std::string metadata : {"", ",", "filename", "filename ", "name YQ==", "filename Y",
                                     "filename ####", "filename YQ==x"})
    EXPECT_EQ(upload_name(metadata), "") << metadata;
  EXPECT_EQ(upload_name("filename " + std::string(2'048, 'A')), "");
}

}  // namespace
}  // namespace vitrine::server
