// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql_jobs.h"

#include <fmt/core.h>

#include <algorithm>

#include "server/catalogue/catalogue.h"

namespace vitrine {
namespace {

using sql::Connection;
using sql::Query;
using sql::Statement;
using sql::Transaction;

constexpr std::string_view kJobColumns =
    "id, kind, state, scanner, scan, model, stage, progress, error, parameters, created, ended, "
    "webhook, attempts";
constexpr std::string_view kScanColumns =
    "id, job, scanner, public, title, parameters, steps, step, points, calibration, model, "
    "created, "
    "empty_rows, saturated_rows, doubled_rows";

void bind_id(Statement& row, const std::optional<ModelId>& id) {
  if (id) {
    row.bind(id->bytes());
  } else {
    row.bind_null();
  }
}

std::optional<ModelId> read_id(const Statement& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  return ModelId::from_bytes(row.blob<16>(column));
}

std::int64_t number(auto value) {
  return static_cast<std::int64_t>(value);
}

Statement& bind_record(Statement& row, const JobRecord& job) {
  row.bind(job.id.bytes()).bind(number(job.kind)).bind(number(job.state)).bind(job.scanner);
  bind_id(row, job.scan);
  bind_id(row, job.model);
  row.bind(job.stage).bind_real(job.progress).bind(job.error).bind(job.parameters);
  return row.bind(job.created).bind(job.ended).bind(job.webhook).bind(number(job.attempts));
}

Statement& bind_record(Statement& row, const ScanEntry& scan) {
  row.bind(scan.id.bytes()).bind(scan.job.bytes()).bind(scan.scanner).bind(number(scan.is_public));
  row.bind(scan.title).bind(scan.parameters).bind(number(scan.steps)).bind(number(scan.step));
  row.bind(number(scan.points)).bind(number(scan.calibration));
  bind_id(row, scan.model);
  row.bind(scan.created);
  if (!scan.rows) return row.bind_null().bind_null().bind_null();
  return row.bind_real(scan.rows->empty)
      .bind_real(scan.rows->saturated)
      .bind_real(scan.rows->doubled);
}

void read(const Statement& row, JobRecord& job) {
  job.id = ModelId::from_bytes(row.blob<16>(0));
  job.kind = static_cast<JobKind>(row.integer(1));
  job.state = static_cast<JobState>(row.integer(2));
  job.scanner = row.text(3);
  job.scan = read_id(row, 4);
  job.model = read_id(row, 5);
  job.stage = row.text(6);
  job.progress = row.real(7);
  job.error = row.text(8);
  job.parameters = row.text(9);
  job.created = row.integer(10);
  job.ended = row.integer(11);
  job.webhook = row.text(12);
  job.attempts = static_cast<std::uint32_t>(row.integer(13));
}

void read(const Statement& row, ScanEntry& scan) {
  scan.id = ModelId::from_bytes(row.blob<16>(0));
  scan.job = ModelId::from_bytes(row.blob<16>(1));
  scan.scanner = row.text(2);
  scan.is_public = row.integer(3) != 0;
  scan.title = row.text(4);
  scan.parameters = row.text(5);
  scan.steps = static_cast<int>(row.integer(6));
  scan.step = static_cast<int>(row.integer(7));
  scan.points = static_cast<std::uint64_t>(row.integer(8));
  scan.calibration = static_cast<int>(row.integer(9));
  scan.model = read_id(row, 10);
  scan.created = row.integer(11);
  if (!row.is_null(12)) scan.rows = {row.real(12), row.real(13), row.real(14)};
}

// "a = ?1, b = ?2, …" of "a, b, …".
std::string assignments(std::string_view columns) {
  std::string text;
  for (int i = 1; !columns.empty(); ++i) {
    const auto name = columns.substr(0, columns.find(','));
    text += fmt::format("{}{} = ?{}", text.empty() ? "" : ", ", name, i);
    columns.remove_prefix(std::min(columns.size(), name.size() + 2));
  }
  return text;
}

// "?,?,…" for "a, b, …".
std::string places(std::string_view columns) {
  std::string text = "?";
  for (auto more = std::ranges::count(columns, ','); more > 0; --more)
    text += ",?";
  return text;
}

// "a = excluded.a, b = excluded.b, …" of "a, b, …".
std::string replacements(std::string_view columns) {
  std::string text;
  while (!columns.empty()) {
    const auto name = columns.substr(0, columns.find(','));
    text += fmt::format("{0}{1} = excluded.{1}", text.empty() ? "" : ", ", name);
    columns.remove_prefix(std::min(columns.size(), name.size() + 2));
  }
  return text;
}

// Whether the row was written.
bool insert(Connection& connection, std::string_view table, std::string_view columns,
            const auto& record, const std::string& otherwise) {
  const Query row(
      connection.prepare(fmt::format("INSERT INTO {}({}) VALUES ({}) ON CONFLICT {} RETURNING 1",
                                     table, columns, places(columns), otherwise)));
  return bind_record(*row, record).any();
}

bool insert_once(Connection& connection, const OnceKey& once, const JobId& job) {
  const Query row(
      connection.prepare("INSERT INTO idempotency(key, request, job) VALUES (?,?,?) "
                         "ON CONFLICT DO NOTHING RETURNING 1"));
  return row->bind(once.key).bind(once.request).bind(job.bytes()).any();
}

template <class Record>
std::vector<Record> all(Statement& rows) {
  std::vector<Record> records;
  while (rows.step())
    read(rows, records.emplace_back());
  return records;
}

class SqlJobs final : public JobCatalogue {
 public:
  explicit SqlJobs(std::shared_ptr<sql::Database> database) : database_(std::move(database)) {}

  Expected<void> add(const JobRecord& job, const std::optional<ScanEntry>& scan,
                     const std::optional<OnceKey>& once) override {
    return sql::guarded<void>(*database_, [&](Connection& connection) -> Expected<void> {
      Transaction transaction(connection);
      if (!insert(connection, "job", kJobColumns, job, "DO NOTHING")) {
        return fail(ErrorCode::kState,
                    fmt::format("job {} exists; use another id", job.id.to_string()));
      }
      if (scan) {
        insert(connection, "scan", kScanColumns, *scan,
               "(id) DO UPDATE SET " + replacements(kScanColumns));
      }
      if (once && !insert_once(connection, *once, job.id)) {
        return fail(ErrorCode::kState, "the key was used meanwhile; send the request again");
      }
      transaction.commit();
      return {};
    });
  }

  Expected<void> update(const JobRecord& job) override { return write("job", kJobColumns, job); }
  Expected<void> update(const ScanEntry& scan) override {
    return write("scan", kScanColumns, scan);
  }

  Expected<std::optional<JobRecord>> find_job(const JobId& id) override {
    return find<JobRecord>("job", kJobColumns, id);
  }
  Expected<std::optional<ScanEntry>> find_scan(const ScanId& id) override {
    return find<ScanEntry>("scan", kScanColumns, id);
  }
  Expected<std::vector<JobRecord>> jobs(const PageOf& page) override {
    return list<JobRecord>("job", kJobColumns, page);
  }
  Expected<std::vector<ScanEntry>> scans(const PageOf& page) override {
    return list<ScanEntry>("scan", kScanColumns, page);
  }

  Expected<std::vector<JobRecord>> unfinished_jobs() override { return jobs_where("state < ?"); }

  Expected<std::vector<JobRecord>> untold_jobs() override {
    return jobs_where("state >= ? AND told = 0 AND webhook != ''");
  }

  Expected<void> set_told(const JobId& id) override {
    return sql::guarded<void>(*database_, [&](Connection& connection) -> Expected<void> {
      const Query row(connection.prepare("UPDATE job SET told = 1 WHERE id = ? RETURNING 1"));
      if (row->bind(id.bytes()).any()) return {};
      return fail(ErrorCode::kState, fmt::format("there is no job {}; list them", id.to_string()));
    });
  }

  Expected<JobCounts> count_jobs() override {
    return sql::guarded<JobCounts>(*database_, [](Connection& connection) -> Expected<JobCounts> {
      const Query row(connection.prepare("SELECT state, count(*) FROM job GROUP BY state"));
      JobCounts counts{};
      while (row->step())
        counts.at(static_cast<std::size_t>(row->integer(0))) =
            static_cast<std::uint64_t>(row->integer(1));
      return counts;
    });
  }

  Expected<std::optional<Earlier>> find_once(const std::string& key) override {
    using Found = std::optional<Earlier>;
    return sql::guarded<Found>(*database_, [&](Connection& connection) -> Expected<Found> {
      const Query row(connection.prepare("SELECT job, request FROM idempotency WHERE key = ?"));
      if (!row->bind(key).step()) return std::nullopt;
      return Earlier{ModelId::from_bytes(row->blob<16>(0)), row->blob<32>(1)};
    });
  }

  Expected<std::size_t> forget(std::int64_t keys_before, std::int64_t jobs_before) override {
    using Count = std::size_t;
    return sql::guarded<Count>(*database_, [&](Connection& connection) -> Expected<Count> {
      Transaction transaction(connection);
      const Query keys(
          connection.prepare("DELETE FROM idempotency WHERE job IN "
                             "(SELECT id FROM job WHERE state >= ? AND created < ?) RETURNING 1"));
      keys->bind(number(JobState::kDone)).bind(keys_before).any();
      const Query jobs(
          connection.prepare("DELETE FROM job WHERE state >= ? AND ended < ? "
                             "AND id NOT IN (SELECT job FROM scan) "
                             "AND id NOT IN (SELECT job FROM idempotency) RETURNING 1"));
      std::size_t forgotten = 0;
      for (jobs->bind(number(JobState::kDone)).bind(jobs_before); jobs->step();)
        ++forgotten;
      transaction.commit();
      return forgotten;
    });
  }

 private:
  // Oldest first; the condition's ? is the first state in which a job has ended.
  Expected<std::vector<JobRecord>> jobs_where(std::string_view condition) {
    using Jobs = std::vector<JobRecord>;
    return sql::guarded<Jobs>(*database_, [&](Connection& connection) -> Expected<Jobs> {
      const Query rows(connection.prepare(
          fmt::format("SELECT {} FROM job WHERE {} ORDER BY id", kJobColumns, condition)));
      return all<JobRecord>(rows->bind(number(JobState::kDone)));
    });
  }

  template <class Record>
  Expected<void> write(std::string_view table, std::string_view columns, const Record& record) {
    return sql::guarded<void>(*database_, [&](Connection& connection) -> Expected<void> {
      const Query row(connection.prepare(
          fmt::format("UPDATE {} SET {} WHERE id = ?1 RETURNING 1", table, assignments(columns))));
      if (bind_record(*row, record).any()) return {};
      return fail(ErrorCode::kState,
                  fmt::format("there is no {} {}; list them", table, record.id.to_string()));
    });
  }

  template <class Record>
  Expected<std::optional<Record>> find(std::string_view table, std::string_view columns,
                                       const ModelId& id) {
    using Found = std::optional<Record>;
    return sql::guarded<Found>(*database_, [&](Connection& connection) -> Expected<Found> {
      const Query row(
          connection.prepare(fmt::format("SELECT {} FROM {} WHERE id = ?", columns, table)));
      if (!row->bind(id.bytes()).step()) return std::nullopt;
      Record record;
      read(*row, record);
      return record;
    });
  }

  template <class Record>
  Expected<std::vector<Record>> list(std::string_view table, std::string_view columns,
                                     const PageOf& page) {
    using Records = std::vector<Record>;
    return sql::guarded<Records>(*database_, [&](Connection& connection) -> Expected<Records> {
      const Query rows(
          connection.prepare(fmt::format("SELECT {} FROM {} {} ORDER BY id DESC LIMIT ?", columns,
                                         table, page.after ? "WHERE id < ?" : "")));
      if (page.after) rows->bind(page.after->bytes());
      return all<Record>(rows->bind(number(std::clamp(page.limit, 1u, kMaxPage))));
    });
  }

  const std::shared_ptr<sql::Database> database_;
};

}  // namespace

std::unique_ptr<JobCatalogue> make_jobs(std::shared_ptr<sql::Database> database) {
  return std::make_unique<SqlJobs>(std::move(database));
}

}  // namespace vitrine
