// SPDX-License-Identifier: Apache-2.0
#include "server/auth/authenticator.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "server/catalogue/sqlite_catalogue.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

using std::chrono_literals::operator""ms;

class AuthenticatorTest : public ::testing::Test {
 protected:
  std::optional<Caller> find(const std::string& text) { return authenticator_.find(text).value(); }
  // Returns all bytes of the database's files.
  std::string stored() const {
    std::string bytes;
    for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
      std::ifstream in(file.path(), std::ios::binary);
      bytes.append(std::istreambuf_iterator<char>(in), {});
    }
    return bytes;
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<Catalogue> catalogue_ =
      open_sqlite_catalogue(folder_.path() / "catalogue.sqlite").value();
  Authenticator authenticator_{*catalogue_};
};

TEST_F(AuthenticatorTest, FindsTheCallerOfAToken) {
  const NewToken a = create_token(*catalogue_, Role::kViewer, "a").value();
  const NewToken b = create_token(*catalogue_, Role::kAdmin, "b").value();
  EXPECT_EQ(find(a.text)->token, a.id);
  EXPECT_EQ(find(a.text)->role, Role::kViewer);
  EXPECT_EQ(find(b.text)->token, b.id);
  EXPECT_EQ(find(b.text)->role, Role::kAdmin);
  ASSERT_TRUE(catalogue_->revoke_token(a.id));
  EXPECT_FALSE(find(a.text));
  EXPECT_TRUE(find(b.text));
}

TEST_F(AuthenticatorTest, AHashWithTheSameStartIsNotAccepted) {
  const std::string token = "vtr_" + std::string(43, 'A');
  Sha256 near = sha256({reinterpret_cast<const std::uint8_t*>(token.data()), token.size()});
  near.back() ^= 1;
  ASSERT_TRUE(catalogue_->add_token({TokenId::generate(), Role::kAdmin, near, "", 0}));
  EXPECT_FALSE(find(token));
}

TEST_F(AuthenticatorTest, NothingThatIsStoredIsAToken) {
  const NewToken token = create_token(*catalogue_, Role::kAdmin, "Anna's laptop").value();
  const std::string bytes = stored();
  ASSERT_NE(bytes.find("Anna's laptop"), std::string::npos);
  EXPECT_EQ(bytes.find("vtr_"), std::string::npos);
  EXPECT_EQ(bytes.find(token.text.substr(4, 12)), std::string::npos);
  const Sha256 hash =
      sha256({reinterpret_cast<const std::uint8_t*>(token.text.data()), token.text.size()});
  EXPECT_NE(bytes.find({reinterpret_cast<const char*>(hash.data()), hash.size()}),
            std::string::npos);
  EXPECT_FALSE(find(to_hex(hash)));
  EXPECT_FALSE(find(token.id.to_string()));
}

TEST_F(AuthenticatorTest, AKnownTokenIsAcceptedForATenthOfASecondWithoutTheCatalogue) {
  const NewToken token = create_token(*catalogue_, Role::kViewer, "a").value();
  const auto start = Authenticator::Clock::now();
  EXPECT_FALSE(authenticator_.cached(token.text, start));
  const auto caller = authenticator_.find(token.text, start).value();
  ASSERT_TRUE(caller);
  ASSERT_TRUE(catalogue_->revoke_token(token.id)) << "as another process does";
  EXPECT_FALSE(authenticator_.cached(token.text, start + 99ms)) << "one is to ask";
  EXPECT_TRUE(authenticator_.cached(token.text, start + 99ms));
  EXPECT_TRUE(authenticator_.is_in_force(*caller, start + 99ms).value());
  EXPECT_FALSE(authenticator_.cached(token.text, start + 100ms));
  EXPECT_FALSE(authenticator_.is_in_force(*caller, start + 100ms).value());
}

TEST_F(AuthenticatorTest, OneCallerAsksAgainForAllBeforeTheTimeIsOver) {
  const NewToken token = create_token(*catalogue_, Role::kViewer, "a").value();
  const auto start = Authenticator::Clock::now();
  ASSERT_TRUE(authenticator_.find(token.text, start).value());
  EXPECT_TRUE(authenticator_.cached(token.text, start + 49ms));
  EXPECT_FALSE(authenticator_.cached(token.text, start + 50ms));
  EXPECT_TRUE(authenticator_.cached(token.text, start + 50ms));
  ASSERT_TRUE(authenticator_.find(token.text, start + 50ms).value());
  EXPECT_TRUE(authenticator_.cached(token.text, start + 99ms));
  EXPECT_FALSE(authenticator_.cached(token.text, start + 100ms)) << "the next who asks";
}

TEST_F(AuthenticatorTest, ATokenRevokedByThisProcessIsRefusedAtOnce) {
  const NewToken token = create_token(*catalogue_, Role::kViewer, "a").value();
  const auto start = Authenticator::Clock::now();
  ASSERT_TRUE(authenticator_.find(token.text, start).value());
  ASSERT_TRUE(catalogue_->revoke_token(token.id));
  authenticator_.forget();
  EXPECT_FALSE(authenticator_.cached(token.text, start));
}

TEST_F(AuthenticatorTest, ALabelIsOneShortLine) {
  for (const std::string& label : {std::string(201, 'a'), std::string("a\nb"), std::string(1, 0)})
    EXPECT_EQ(create_token(*catalogue_, Role::kViewer, label).error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace vitrine::server
