// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/postgres.h"

#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

namespace vitrine::server::postgres {
namespace {

constexpr const char* kAdvice = "check the PostgreSQL server and the setting catalogue";
// OIDs of the types BYTEA, BIGINT, TEXT and DOUBLE PRECISION in the system table pg_type.
constexpr Oid kBytes = 17, kInteger = 20, kText = 25, kReal = 701;

// Returns the first line of a message of libpq, without the severity and the newline.
std::string first_line(std::string_view message) {
  for (const std::string_view severity : {"ERROR:  ", "FATAL:  "}) {
    if (message.starts_with(severity)) message.remove_prefix(severity.size());
  }
  return std::string(message.substr(0, message.find('\n')));
}

// Converts the parameters of a statement to PostgreSQL's form: "?" to "$1", "$2" …, and "?N" to
// "$N".
std::string with_dollars(std::string_view sql) {
  std::string text;
  int count = 0;
  for (std::size_t i = 0; i < sql.size(); ++i) {
    const bool is_numbered =
        i + 1 < sql.size() && std::isdigit(static_cast<unsigned char>(sql[i + 1]));
    if (sql[i] != '?') {
      text += sql[i];
    } else {
      text += is_numbered ? "$" : fmt::format("${}", ++count);
    }
  }
  return text;
}

// Replaces invalid UTF-8 and removes null bytes, which PostgreSQL does not accept as text. An error
// message may quote such bytes from a hostile file.
std::string as_utf8(std::string_view text) {
  constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
  auto valid =
      nlohmann::json::parse(nlohmann::json(text).dump(-1, ' ', false, kReplace)).get<std::string>();
  std::erase(valid, '\0');
  return valid;
}

template <class Word>
Word big_endian(const char* bytes) {
  Word word = 0;
  for (std::size_t i = 0; i < sizeof word; ++i)
    word = static_cast<Word>(word << 8 | static_cast<std::uint8_t>(bytes[i]));
  return word;
}

std::string big_endian_text(std::uint64_t word) {
  std::string text(sizeof word, '\0');
  for (std::size_t i = text.size(); i-- > 0; word >>= 8)
    text[i] = static_cast<char>(word);
  return text;
}

// A prepared statement that sends and receives values in PostgreSQL's binary format.
class PostgresStatement final : public sql::Statement {
 public:
  PostgresStatement(PostgresConnection& connection, const std::string& sql, std::string name)
      : connection_(connection), sql_(with_dollars(sql)), name_(std::move(name)) {}

  PostgresStatement& reset() override {
    values_.clear();
    result_.reset();
    return *this;
  }
  PostgresStatement& bind(std::int64_t value) override {
    return add(kInteger, big_endian_text(static_cast<std::uint64_t>(value)));
  }
  PostgresStatement& bind_real(double value) override {
    return add(kReal, big_endian_text(std::bit_cast<std::uint64_t>(value)));
  }
  PostgresStatement& bind_null() override { return add(0, std::nullopt); }
  PostgresStatement& bind(std::string_view text) override { return add(kText, as_utf8(text)); }
  PostgresStatement& bind(std::span<const std::uint8_t> blob) override {
    return add(kBytes, std::string(reinterpret_cast<const char*>(blob.data()), blob.size()));
  }

  bool step() override {
    if (!result_) {
      if (!is_prepared_) prepare();
      execute();
      row_ = -1;
    }
    return ++row_ < PQntuples(result_.get());
  }

  std::int64_t integer(int column) const override {
    const char* const value = PQgetvalue(result_.get(), row_, column);
    if (PQgetlength(result_.get(), row_, column) == 4)
      return static_cast<std::int32_t>(big_endian<std::uint32_t>(value));
    return static_cast<std::int64_t>(big_endian<std::uint64_t>(check_length(column, 8)));
  }
  double real(int column) const override {
    return std::bit_cast<double>(big_endian<std::uint64_t>(check_length(column, 8)));
  }
  bool is_null(int column) const override { return PQgetisnull(result_.get(), row_, column) == 1; }
  std::string text(int column) const override {
    return {PQgetvalue(result_.get(), row_, column),
            static_cast<std::size_t>(PQgetlength(result_.get(), row_, column))};
  }

  void bind_to(sql::Statement& other, int column) const override {
    const std::string value = text(column);
    if (is_null(column)) {
      other.bind_null();
    } else if (PQftype(result_.get(), column) == kReal) {
      other.bind_real(real(column));
    } else if (PQftype(result_.get(), column) == kText) {
      other.bind(value);
    } else if (PQftype(result_.get(), column) == kBytes) {
      other.bind(std::span(reinterpret_cast<const std::uint8_t*>(value.data()), value.size()));
    } else {
      other.bind(integer(column));
    }
  }

 private:
  PostgresStatement& add(Oid type, std::optional<std::string> value) {
    values_.push_back({type, std::move(value)});
    return *this;
  }

  // Prepares the statement on the server, and asks the server for the number of its parameters.
  void prepare() {
    std::vector<Oid> types;
    for (const Value& value : values_)
      types.push_back(value.type);
    connection_.receive(PQsendPrepare(connection_.handle(), name_.c_str(), sql_.c_str(),
                                      static_cast<int>(types.size()), types.data()),
                        kResponseTimeout);
    connection_
        .receive(PQsendDescribePrepared(connection_.handle(), name_.c_str()), kResponseTimeout)
        .swap(result_);
    parameters_ = static_cast<std::size_t>(PQnparams(result_.get()));
    is_prepared_ = true;
  }

  void execute() {
    values_.resize(std::max(values_.size(), parameters_));
    std::vector<const char*> values;
    std::vector<int> lengths;
    for (const Value& value : values_) {
      values.push_back(value.bytes ? value.bytes->data() : nullptr);
      lengths.push_back(value.bytes ? static_cast<int>(value.bytes->size()) : 0);
    }
    const std::vector<int> formats(values.size(), 1);
    result_ = connection_.receive(
        PQsendQueryPrepared(connection_.handle(), name_.c_str(), static_cast<int>(values.size()),
                            values.data(), lengths.data(), formats.data(), 1),
        kResponseTimeout);
  }

  const char* check_length(int column, int wanted) const {
    if (PQgetlength(result_.get(), row_, column) != wanted)
      throw sql::Failure("a column does not have the expected length", ErrorCode::kIo, kAdvice);
    return PQgetvalue(result_.get(), row_, column);
  }
  void copy_blob(int column, std::span<std::uint8_t> out) const override {
    std::memcpy(out.data(), check_length(column, static_cast<int>(out.size())), out.size());
  }

  struct Value {
    Oid type = 0;
    std::optional<std::string> bytes;
  };
  PostgresConnection& connection_;
  const std::string sql_, name_;
  bool is_prepared_ = false;
  std::size_t parameters_ = 0;
  std::vector<Value> values_;
  QueryResult result_;
  int row_ = -1;
};

}  // namespace

// The parameters before "dbname" are defaults, which the parameters in `url` override. If the URL
// is malformed, libpq's message is not reported, because it may quote parts of the password.
PostgresConnection::PostgresConnection(const std::string& url) {
  PQconninfoOption* const options = PQconninfoParse(url.c_str(), nullptr);
  if (options == nullptr)
    throw sql::Failure("the setting 'catalogue' is not a PostgreSQL URL", ErrorCode::kIo, kAdvice);
  PQconninfoFree(options);
  constexpr std::array kNames{"connect_timeout",
                              "tcp_user_timeout",
                              "keepalives_idle",
                              "client_encoding",
                              "fallback_application_name",
                              "dbname",
                              static_cast<const char*>(nullptr)};
  const std::array values{
      "5", "10000", "10", "UTF8", "vitrine", url.c_str(), static_cast<const char*>(nullptr)};
  handle_.reset(PQconnectdbParams(kNames.data(), values.data(), /*expand_dbname=*/1));
  if (PQstatus(handle()) != CONNECTION_OK) raise(nullptr);
  PQsetNoticeProcessor(
      handle(), [](void*, const char*) {}, nullptr);
}

bool PostgresConnection::is_alive() {
  if (hangs_ || PQstatus(handle()) != CONNECTION_OK) return false;
  pollfd socket{PQsocket(handle()), POLLIN, 0};
  // Between statements, the server sends data only when it closes the connection. So a readable
  // socket means a closed connection.
  return ::poll(&socket, 1, 0) == 0;
}

void PostgresConnection::raise(const PGresult* result) const {
  const char* const state = PQresultErrorField(result, PG_DIAG_SQLSTATE);
  std::string message = first_line(result != nullptr ? PQresultErrorMessage(result) : "");
  if (message.empty()) message = first_line(PQerrorMessage(handle()));
  if (state != nullptr && std::string_view(state) == "53100")
    throw sql::Failure(message, ErrorCode::kLimit, "free some space on the PostgreSQL server");
  throw sql::Failure(message, ErrorCode::kIo, kAdvice);
}

void PostgresConnection::wait_for_answer(std::optional<std::chrono::seconds> timeout) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + timeout.value_or(std::chrono::seconds(0));
  while (PQisBusy(handle()) == 1) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd socket{PQsocket(handle()), POLLIN, 0};
    const int wait = timeout ? static_cast<int>(std::max<std::int64_t>(left, 0)) : -1;
    const int ready = ::poll(&socket, 1, wait);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) {
      hangs_ = true;
      throw sql::Failure("the PostgreSQL server does not answer", ErrorCode::kIo, kAdvice);
    }
    if (PQconsumeInput(handle()) != 1) raise(nullptr);
  }
}

QueryResult PostgresConnection::receive(int was_sent, std::optional<std::chrono::seconds> timeout) {
  if (was_sent != 1) raise(nullptr);
  QueryResult last, fault;
  for (;;) {
    wait_for_answer(timeout);
    QueryResult next(PQgetResult(handle()));
    if (!next) break;
    const auto status = PQresultStatus(next.get());
    const bool is_good = status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK;
    (is_good ? last : fault) = std::move(next);
  }
  if (fault) raise(fault.get());
  return last;
}

void PostgresConnection::run(const char* sql) {
  receive(PQsendQuery(handle(), sql), kResponseTimeout);
}

sql::Statement& PostgresConnection::prepare(const std::string& sql) {
  auto& statement = statements_[sql];
  if (!statement)
    statement =
        std::make_unique<PostgresStatement>(*this, sql, fmt::format("s{}", statements_.size()));
  return *statement;
}

void PostgresConnection::roll_back() noexcept {
  try {
    if (is_alive()) run("ROLLBACK");
  } catch (const sql::Failure&) {  // the server rolls back when the connection ends
    hangs_ = true;
  }
}

// Quotes each word, so that PostgreSQL does not read it as a query operator.
std::string PostgresConnection::text_query(std::span<const std::string> words) const {
  std::string query;
  for (const std::string& word : words)
    query += (query.empty() ? "'" : " & '") + word + "':*";
  return query;
}

std::uint64_t PostgresConnection::revision() {
  const sql::ScopedStatement row(prepare("SELECT number FROM revision"));
  row->step();
  return static_cast<std::uint64_t>(row->integer(0));
}

void PostgresConnection::lock(std::int64_t number) {
  const std::string sql = fmt::format("SELECT pg_advisory_lock({})", number);
  receive(PQsendQuery(handle(), sql.c_str()), std::nullopt);
}

void PostgresConnection::unlock(std::int64_t number) {
  run(fmt::format("SELECT pg_advisory_unlock({})", number).c_str());
}

}  // namespace vitrine::server::postgres
