// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql_catalogue.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>

#include "server/catalogue/catalogue.h"

namespace vitrine::server {
namespace {

using sql::DatabaseConnection;
using sql::ScopedStatement;
using sql::Statement;
using sql::Transaction;

constexpr std::string_view kJobColumns =
    "id, kind, state, scanner, scan, model, stage, progress, error, parameters, created, ended, "
    "webhook, attempts, fence, repairs, owner";
constexpr std::string_view kScanColumns =
    "id, job, scanner, public, title, parameters, steps, step, points, calibration, model, "
    "created, empty_rows, saturated_rows, doubled_rows, turn, built";

template <class Tag>
void bind_id(Statement& row, const std::optional<Id<Tag>>& id) {
  if (id) {
    row.bind(id->bytes());
  } else {
    row.bind_null();
  }
}

template <class AnyId>
std::optional<AnyId> read_id(const Statement& row, int column) {
  if (row.is_null(column)) return std::nullopt;
  return AnyId::from_bytes(row.blob<16>(column));
}

std::int64_t number(auto value) {
  return static_cast<std::int64_t>(value);
}

Statement& bind_record(Statement& row, const JobRecord& job) {
  row.bind(job.id.bytes()).bind(number(job.kind)).bind(number(job.state)).bind(job.scanner);
  bind_id(row, job.scan);
  bind_id(row, job.model);
  row.bind(job.stage).bind_real(job.progress).bind(job.error).bind(job.parameters);
  row.bind(job.created).bind(job.ended).bind(job.webhook).bind(number(job.attempts));
  return row.bind(number(job.fence)).bind(job.repairs).bind(job.owner);
}

Statement& bind_record(Statement& row, const ScanEntry& scan) {
  row.bind(scan.id.bytes()).bind(scan.job.bytes()).bind(scan.scanner).bind(number(scan.is_public));
  row.bind(scan.title).bind(scan.parameters).bind(number(scan.steps)).bind(number(scan.step));
  row.bind(number(scan.points)).bind(number(scan.calibration));
  bind_id(row, scan.model);
  row.bind(scan.created);
  if (scan.rows) {
    row.bind_real(scan.rows->empty).bind_real(scan.rows->saturated).bind_real(scan.rows->doubled);
  } else {
    row.bind_null().bind_null().bind_null();
  }
  row.bind(scan.revolution);
  return scan.built ? row.bind(*scan.built) : row.bind_null();
}

void read(const Statement& row, JobRecord& job) {
  job.id = JobId::from_bytes(row.blob<16>(0));
  job.kind = sql::checked(row.integer(1), JobKind::kPublish);
  job.state = sql::checked(row.integer(2), JobState::kCancelled);
  job.scanner = row.text(3);
  job.scan = read_id<ScanId>(row, 4);
  job.model = read_id<ModelId>(row, 5);
  job.stage = row.text(6);
  job.progress = row.real(7);
  job.error = row.text(8);
  job.parameters = row.text(9);
  job.created = row.integer(10);
  job.ended = row.integer(11);
  job.webhook = row.text(12);
  job.attempts = static_cast<std::uint32_t>(row.integer(13));
  job.fence = static_cast<std::uint64_t>(row.integer(14));
  job.repairs = row.text(15);
  job.owner = row.text(16);
}

void read(const Statement& row, ScanEntry& scan) {
  scan.id = ScanId::from_bytes(row.blob<16>(0));
  scan.job = JobId::from_bytes(row.blob<16>(1));
  scan.scanner = row.text(2);
  scan.is_public = row.integer(3) != 0;
  scan.title = row.text(4);
  scan.parameters = row.text(5);
  scan.steps = static_cast<int>(row.integer(6));
  scan.step = static_cast<int>(row.integer(7));
  scan.points = static_cast<std::uint64_t>(row.integer(8));
  scan.calibration = static_cast<int>(row.integer(9));
  scan.model = read_id<ModelId>(row, 10);
  scan.created = row.integer(11);
  if (!row.is_null(12)) scan.rows = {row.real(12), row.real(13), row.real(14)};
  scan.revolution = row.text(15);
  if (!row.is_null(16)) scan.built = row.blob<32>(16);
}

// Returns "a = ?1, b = ?2, …" for the columns "a, b, …".
std::string assignments(std::string_view columns) {
  std::string text;
  for (int i = 1; !columns.empty(); ++i) {
    const auto name = columns.substr(0, columns.find(','));
    text += fmt::format("{}{} = ?{}", text.empty() ? "" : ", ", name, i);
    columns.remove_prefix(std::min(columns.size(), name.size() + 2));
  }
  return text;
}

// Returns "?,?,…" with a ? for each of the columns "a, b, …".
std::string places(std::string_view columns) {
  std::string text = "?";
  for (auto more = std::ranges::count(columns, ','); more > 0; --more)
    text += ",?";
  return text;
}

// Returns "a = excluded.a, b = excluded.b, …" for the columns "a, b, …".
std::string replacements(std::string_view columns) {
  std::string text;
  while (!columns.empty()) {
    const auto name = columns.substr(0, columns.find(','));
    text += fmt::format("{0}{1} = excluded.{1}", text.empty() ? "" : ", ", name);
    columns.remove_prefix(std::min(columns.size(), name.size() + 2));
  }
  return text;
}

// Inserts a row for `record`. `otherwise` is the rest of the ON CONFLICT clause. Returns whether a
// row was written.
bool insert(DatabaseConnection& connection, std::string_view table, std::string_view columns,
            const auto& record, const std::string& otherwise) {
  const ScopedStatement row(
      connection.prepare(fmt::format("INSERT INTO {}({}) VALUES ({}) ON CONFLICT {} RETURNING 1",
                                     table, columns, places(columns), otherwise)));
  return bind_record(*row, record).any();
}

bool insert_key(DatabaseConnection& connection, const IdempotencyKey& key, const JobId& job) {
  const ScopedStatement row(
      connection.prepare("INSERT INTO idempotency(key, request, job) VALUES (?,?,?) "
                         "ON CONFLICT DO NOTHING RETURNING 1"));
  return row->bind(key.key).bind(key.request).bind(job.bytes()).any();
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
                     const std::optional<IdempotencyKey>& key) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      Transaction transaction(connection);
      if (!insert(connection, "job", kJobColumns, job, "DO NOTHING")) {
        return fail(ErrorCode::kState,
                    fmt::format("job {} exists; use another id", job.id.to_string()));
      }
      if (scan) {
        insert(connection, "scan", kScanColumns, *scan,
               "(id) DO UPDATE SET " + replacements(kScanColumns));
      }
      if (key && !insert_key(connection, *key, job.id)) {
        return fail(ErrorCode::kState,
                    "another request has used the idempotency key; send the request again");
      }
      transaction.commit();
      return {};
    });
  }

  Expected<void> update(const JobRecord& job) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) {
      return write(connection, "job",
                   assignments(kJobColumns) + ", lease = CASE WHEN ?3 = 1 THEN lease ELSE 0 END",
                   "AND fence = ?15", job);
    });
  }
  // Updates the scan if `by` still holds its job. The job's row stays locked until the transaction
  // ends, so that no other daemon claims the job in the meantime.
  Expected<void> update(const ScanEntry& scan, const JobClaim& by) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      Transaction transaction(connection);
      const ScopedStatement held(connection.prepare(
          "UPDATE job SET fence = fence WHERE id = ?1 AND fence = ?2 RETURNING 1"));
      if (!held->bind(by.job.bytes()).bind(number(by.fence)).any()) return lost(by.job);
      auto written = write(connection, "scan", assignments(kScanColumns), "", scan);
      if (written) transaction.commit();
      return written;
    });
  }

  Expected<std::optional<JobRecord>> claim(const JobId& id, const Lease& lease) override {
    using Found = std::optional<JobRecord>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Found> {
      Transaction transaction(connection);
      const ScopedStatement free(
          connection.prepare(fmt::format("SELECT 1 FROM job WHERE id = ? AND {} {}",
                                         is_free(connection), connection.skip_locked())));
      if (!free->bind(id.bytes()).any()) return std::nullopt;
      const ScopedStatement row(connection.prepare(
          fmt::format("UPDATE job SET state = 1, fence = fence + 1, attempts = attempts + 1, "
                      "holder = ?2, lease = {} + ?3 WHERE id = ?1 RETURNING {}",
                      connection.now(), kJobColumns)));
      row->bind(id.bytes()).bind(lease.holder).bind(number(lease.time.count()));
      JobRecord job = all<JobRecord>(*row).front();
      transaction.commit();
      return job;
    });
  }

  Expected<std::vector<JobRecord>> waiting_jobs(std::span<const JobKind> kinds, std::uint32_t limit,
                                                bool overdue) override {
    using Jobs = std::vector<JobRecord>;
    if (kinds.empty()) return Jobs();
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Jobs> {
      std::string places = "?";
      for (std::size_t i = 1; i < kinds.size(); ++i)
        places += ",?";
      // Numbers the jobs of each owner and scanner, running jobs first, and orders the waiting jobs
      // by this number. Owners with fewer running jobs therefore come first.
      const ScopedStatement rows(connection.prepare(fmt::format(
          "SELECT {0} FROM job JOIN (SELECT id AS waiting, row_number() OVER "
          "(PARTITION BY owner, scanner ORDER BY CASE WHEN {2} THEN 1 ELSE 0 END, id) AS place "
          "FROM job WHERE kind IN ({1}) AND state IN (0, 1)) AS places ON id = waiting "
          "WHERE {2} ORDER BY place, id LIMIT ?",
          kJobColumns, places, overdue ? is_free(connection) : kLeft)));
      for (const JobKind kind : kinds)
        rows->bind(number(kind));
      return all<JobRecord>(rows->bind(number(limit)));
    });
  }

  Expected<bool> renew(const JobRecord& job, std::chrono::milliseconds lease) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<bool> {
      const ScopedStatement row(connection.prepare(
          fmt::format("UPDATE job SET lease = {} + ?3, stage = ?4, progress = ?5 "
                      "WHERE id = ?1 AND fence = ?2 AND state IN (1, 2) RETURNING cancelled",
                      connection.now())));
      row->bind(job.id.bytes()).bind(number(job.fence)).bind(number(lease.count()));
      if (row->bind(job.stage).bind_real(job.progress).step()) return row->integer(0) != 0;
      return lost(job.id);
    });
  }

  Expected<JobRecord> cancel(const JobId& id, std::int64_t now) override {
    return sql::with_connection(
        *database_, [&](DatabaseConnection& connection) -> Expected<JobRecord> {
          const ScopedStatement row(connection.prepare(fmt::format(
              "UPDATE job SET cancelled = 1, fence = CASE WHEN {0} THEN fence ELSE fence + 1 END, "
              "state = CASE WHEN {0} THEN state WHEN state = 1 AND model IS NOT NULL THEN 3 ELSE 5 "
              "END, ended = CASE WHEN {0} THEN ended ELSE "
              "?2 "
              "END WHERE id = ?1 AND state < 3 RETURNING {1}",
              fmt::format("state IN (1, 2) AND lease > {}", connection.now()), kJobColumns)));
          auto changed = all<JobRecord>(row->bind(id.bytes()).bind(now));
          if (!changed.empty()) return std::move(changed.front());
          return fail(ErrorCode::kState,
                      fmt::format("job {} has ended; start another", id.to_string()));
        });
  }

  Expected<void> drop_leases(const std::string& holder) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement rows(connection.prepare(
          "UPDATE job SET lease = 0 WHERE holder = ? AND lease != 0 RETURNING 1"));
      rows->bind(holder).any();
      return {};
    });
  }

  Expected<std::optional<std::uint64_t>> take_scanner(const std::string& scanner,
                                                      const Lease& lease,
                                                      const std::string& address) override {
    using Epoch = std::optional<std::uint64_t>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Epoch> {
      const ScopedStatement row(connection.prepare(fmt::format(
          "INSERT INTO scanner(name, holder, address, lease, epoch) VALUES (?1, ?2, ?3, {0} + ?4, "
          "1) ON CONFLICT (name) DO UPDATE SET holder = ?2, address = ?3, lease = {0} + ?4, "
          "epoch = scanner.epoch + 1 WHERE scanner.holder = ?2 OR scanner.lease < {0} "
          "RETURNING epoch",
          connection.now())));
      row->bind(scanner).bind(lease.holder).bind(address).bind(number(lease.time.count()));
      if (!row->step()) return std::nullopt;
      return static_cast<std::uint64_t>(row->integer(0));
    });
  }

  Expected<void> renew_scanner(const std::string& scanner, std::uint64_t epoch,
                               std::chrono::milliseconds lease) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement row(connection.prepare(
          fmt::format("UPDATE scanner SET lease = {} + ?3 WHERE name = ?1 AND epoch = ?2 "
                      "RETURNING 1",
                      connection.now())));
      if (row->bind(scanner).bind(number(epoch)).bind(number(lease.count())).any()) return {};
      return fail(ErrorCode::kState,
                  fmt::format("another daemon drives scanner {} now; stop one of them", scanner));
    });
  }

  Expected<void> drop_scanners(const std::string& holder) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement rows(
          connection.prepare("UPDATE scanner SET lease = 0 WHERE holder = ? RETURNING 1"));
      rows->bind(holder).any();
      return {};
    });
  }

  Expected<std::vector<ScannerDriver>> scanner_drivers() override {
    using Drivers = std::vector<ScannerDriver>;
    return sql::with_connection(
        *database_, [](DatabaseConnection& connection) -> Expected<Drivers> {
          const ScopedStatement rows(connection.prepare(
              fmt::format("SELECT name, holder, address, CASE WHEN lease < {} THEN 0 ELSE 1 END "
                          "FROM scanner ORDER BY name",
                          connection.now())));
          Drivers drivers;
          while (rows->step())
            drivers.push_back({rows->text(0), rows->text(1), rows->text(2), rows->integer(3) != 0});
          return drivers;
        });
  }

  Expected<std::optional<JobRecord>> find_job(const JobId& id) override {
    return find<JobRecord>("job", kJobColumns, id);
  }
  Expected<std::optional<ScanEntry>> find_scan(const ScanId& id) override {
    return find<ScanEntry>("scan", kScanColumns, id);
  }
  Expected<std::vector<JobRecord>> jobs(const PageOf<JobId>& page) override {
    return list<JobRecord>("job", kJobColumns, page);
  }
  Expected<std::vector<ScanEntry>> scans(const PageOf<ScanId>& page) override {
    return list<ScanEntry>("scan", kScanColumns, page);
  }

  Expected<std::vector<JobRecord>> unfinished_jobs() override { return jobs_where("state < 3"); }

  Expected<std::vector<JobRecord>> paused_jobs() override { return jobs_where("state = 2"); }

  Expected<std::vector<JobRecord>> unnotified_jobs() override {
    return jobs_where("state >= 3 AND told != 1 AND webhook != ''");
  }

  Expected<std::vector<JobRecord>> claim_unnotified(const Lease& lease) override {
    using Jobs = std::vector<JobRecord>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Jobs> {
      const std::string is_untold = fmt::format(
          "state >= 3 AND told != 1 AND webhook != '' AND lease < {}", connection.now());
      std::vector<JobId> ids;
      {
        const ScopedStatement rows(connection.prepare(
            fmt::format("SELECT id FROM job WHERE {} ORDER BY id LIMIT 16", is_untold)));
        while (rows->step())
          ids.push_back(JobId::from_bytes(rows->blob<16>(0)));
      }
      Jobs jobs;
      for (const JobId& id : ids) {
        const ScopedStatement row(connection.prepare(
            fmt::format("UPDATE job SET holder = ?2, lease = {} + ?3 WHERE id = ?1 AND {} "
                        "RETURNING {}",
                        connection.now(), is_untold, kJobColumns)));
        row->bind(id.bytes()).bind(lease.holder).bind(number(lease.time.count()));
        std::ranges::move(all<JobRecord>(*row), std::back_inserter(jobs));
      }
      return jobs;
    });
  }

  Expected<void> renew_unnotified(const JobId& id, const Lease& lease) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement row(connection.prepare(
          fmt::format("UPDATE job SET lease = {} + ?3 WHERE id = ?1 AND holder = ?2 AND told != 1 "
                      "RETURNING 1",
                      connection.now())));
      row->bind(id.bytes()).bind(lease.holder).bind(number(lease.time.count()));
      return row->any() ? Expected<void>{} : lost(id);
    });
  }

  Expected<void> set_notified(const JobId& id) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement row(
          connection.prepare("UPDATE job SET told = 1 WHERE id = ? RETURNING 1"));
      if (row->bind(id.bytes()).any()) return {};
      return fail(ErrorCode::kState, fmt::format("there is no job {}; list them", id.to_string()));
    });
  }

  Expected<JobCounts> count_jobs() override {
    return sql::with_connection(
        *database_, [](DatabaseConnection& connection) -> Expected<JobCounts> {
          const ScopedStatement row(
              connection.prepare("SELECT state, count(*) FROM job GROUP BY state"));
          JobCounts counts{};
          while (row->step()) {
            const auto state = sql::checked(row->integer(0), JobState::kCancelled);
            counts[static_cast<std::size_t>(state)] = static_cast<std::uint64_t>(row->integer(1));
          }
          return counts;
        });
  }

  Expected<std::optional<Earlier>> find_key(const std::string& key) override {
    using Found = std::optional<Earlier>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Found> {
      const ScopedStatement row(
          connection.prepare("SELECT job, request FROM idempotency WHERE key = ?"));
      if (!row->bind(key).step()) return std::nullopt;
      return Earlier{JobId::from_bytes(row->blob<16>(0)), row->blob<32>(1)};
    });
  }

  Expected<std::size_t> forget(std::int64_t keys_before, std::int64_t jobs_before) override {
    using Count = std::size_t;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Count> {
      Transaction transaction(connection);
      const ScopedStatement keys(
          connection.prepare("DELETE FROM idempotency WHERE job IN "
                             "(SELECT id FROM job WHERE state >= ? AND created < ?) RETURNING 1"));
      keys->bind(number(JobState::kDone)).bind(keys_before).any();
      const ScopedStatement jobs(
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
  // SQL condition: the job is queued, or it runs without a lease because its daemon has restarted.
  static constexpr const char* kLeft = "(state = 0 OR (state = 1 AND lease = 0))";
  // SQL condition: the job is queued, or it runs without a valid lease.
  static std::string is_free(const DatabaseConnection& connection) {
    return fmt::format("(state = 0 OR (state = 1 AND lease < {}))", connection.now());
  }

  // Returns the jobs that meet the SQL condition, oldest first.
  Expected<std::vector<JobRecord>> jobs_where(std::string_view condition) {
    using Jobs = std::vector<JobRecord>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Jobs> {
      const ScopedStatement rows(connection.prepare(
          fmt::format("SELECT {} FROM job WHERE {} ORDER BY id", kJobColumns, condition)));
      return all<JobRecord>(*rows);
    });
  }

  static Unexpected lost(const JobId& job) {
    return fail(
        ErrorCode::kState,
        fmt::format("another daemon has claimed or ended job {}; reload the job", job.to_string()));
  }

  template <class Record>
  static Expected<void> write(DatabaseConnection& connection, std::string_view table,
                              const std::string& changes, std::string_view condition,
                              const Record& record) {
    const ScopedStatement row(connection.prepare(
        fmt::format("UPDATE {} SET {} WHERE id = ?1 {} RETURNING 1", table, changes, condition)));
    if (bind_record(*row, record).any()) return {};
    return fail(ErrorCode::kState, fmt::format("there is no {} {} in that state; list them", table,
                                               record.id.to_string()));
  }

  template <class Record, class Id>
  Expected<std::optional<Record>> find(std::string_view table, std::string_view columns,
                                       const Id& id) {
    using Found = std::optional<Record>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Found> {
      const ScopedStatement row(
          connection.prepare(fmt::format("SELECT {} FROM {} WHERE id = ?", columns, table)));
      if (!row->bind(id.bytes()).step()) return std::nullopt;
      Record record;
      read(*row, record);
      return record;
    });
  }

  template <class Record, class Id>
  Expected<std::vector<Record>> list(std::string_view table, std::string_view columns,
                                     const PageOf<Id>& page) {
    using Records = std::vector<Record>;
    return sql::with_connection(
        *database_, [&](DatabaseConnection& connection) -> Expected<Records> {
          const ScopedStatement rows(
              connection.prepare(fmt::format("SELECT {} FROM {} {} ORDER BY id DESC LIMIT ?",
                                             columns, table, page.after ? "WHERE id < ?" : "")));
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

}  // namespace vitrine::server
