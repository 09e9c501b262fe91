#include "precompute/columns/work_file.hpp"

#include <exception>

#include "common/error.hpp"
#include "common/process/signal_cleanup.hpp"
#include "common/response/modal_response.hpp"
#include "precompute/columns/assemble.hpp"
#include "precompute/columns/column_file.hpp"
#include "precompute/columns/compute_columns.hpp"

namespace irdm::precompute {
namespace {

constexpr const char* kGoesOn =
    "irdm-precompute: interrupted; the same command goes on from where it was\n";

std::filesystem::path work_name(const std::filesystem::path& output, int rank, int size) {
  std::string name = output.string() + ".columns";
  if (size > 1)
    name.append(".").append(std::to_string(rank)).append("-of-").append(std::to_string(size));
  return name;
}

// Each block is on the disk before the next one counts.
class FileStore final : public ColumnStore {
 public:
  FileStore(ColumnFileWriter& file, std::size_t column_bytes, Progress& progress)
      : file_(file), column_bytes_(column_bytes), progress_(progress) {}

  void put(int /*b*/, const float* values) override { append(values); }
  void put(int /*b*/, const double* values) override { append(values); }
  void flush() override {
    file_.sync();
    progress_.update(done_);
  }

 private:
  void append(const void* values) {
    file_.append({static_cast<const std::uint8_t*>(values), column_bytes_});
    ++done_;
  }

  ColumnFileWriter& file_;
  std::size_t column_bytes_;
  Progress& progress_;
  int done_ = 0;
};

void tell_of_earlier_run(const ColumnFileWriter& file, const std::filesystem::path& path,
                         const ColumnRange& range, const Console& console) {
  if (file.replaced()) {
    console.line(path.string() + " was of another configuration: starting anew");
  }
  if (file.resumed() > 0) {
    console.line(path.string() + " has " + std::to_string(file.resumed()) + " of " +
                 std::to_string(range.count()) + " columns: going on from there");
  }
}

// Those of loads on the whole body come last and are made anew by a run that goes on.
void append_load(const Columns& columns, int count, ColumnFileWriter& file) {
  std::visit(
      [&](const auto& values) {
        const Eigen::Index steps = values.rows() / count;
        for (Eigen::Index p = 0; p < count; ++p) {
          const auto column = values.middleRows(p * steps, steps);
          file.append({reinterpret_cast<const std::uint8_t*>(column.data()),
                       static_cast<std::size_t>(column.size()) * sizeof(column(0, 0))});
        }
      },
      columns);
}

// Returns the number of columns that were computed.
int complete(ColumnFileWriter& file, const std::filesystem::path& path, const ColumnSource& source,
             const ColumnFileHeader& header, int threads, const Console& console) {
  tell_of_earlier_run(file, path, header.range, console);
  const ColumnRange left{header.range.begin + file.resumed(), header.range.end};
  const SignalCleanup message({.say = kGoesOn});
  if (left.count() > 0) {
    Progress progress(console, "columns of R", left.count());
    FileStore store(file, header.column_bytes(), progress);
    compute_columns(source, left, threads, store);
  }
  if (header.centrifugal) append_load(source.centrifugal(), kSpinProducts, file);
  if (header.gravity) append_load(source.gravity(), kGravityColumns, file);
  return left.count();
}

// One part of the work of all ranks: none goes on before all have done it. Throws when one failed.
template <typename Part>
void together(const Ranks& ranks, const std::filesystem::path& output, const Part& part) {
  std::exception_ptr failure;
  try {
    part();
  } catch (...) {
    failure = std::current_exception();
  }
  const bool good = ranks.all(!failure);
  if (failure) std::rethrow_exception(failure);
  if (!good) throw Error(output.string(), "another rank failed", "see its message");
}

double join(const ColumnWork& work, int size, const Console& console) {
  std::vector<std::filesystem::path> parts;
  for (int rank = 0; rank < size; ++rank) parts.push_back(work_name(work.output, rank, size));
  // Nobody else writes under this name while the work file is locked.
  const std::filesystem::path temporary = work.output.string() + ".part";
  const SignalCleanup cleanup({.remove = temporary, .say = kGoesOn});
  const double left = assemble(parts, work.output, temporary, console);
  for (const auto& part : parts) std::filesystem::remove(part);
  return left;
}

}  // namespace

ColumnsDone write_by_columns(const ColumnSource& source, const ColumnWork& work, const Ranks& ranks,
                             const Console& console) {
  ColumnFileHeader mine = work.header;
  mine.range = share_of(work.header.range, ranks.rank(), ranks.size(), source.block_size());
  const std::filesystem::path path = work_name(work.output, ranks.rank(), ranks.size());
  ColumnsDone done;
  std::optional<ColumnFileWriter> file;  // locked until the parts are joined
  together(ranks, work.output, [&] {
    if (mine.range.count() == 0) {
      throw Error(work.output.string(), "there are more ranks than blocks of columns",
                  "use fewer ranks");
    }
    file.emplace(path, mine);
    done.computed = complete(*file, path, source, mine, work.threads, console);
  });
  together(ranks, work.output, [&] {
    if (work.slice) {
      file->commit(work.output);
    } else if (ranks.rank() == 0) {
      done.decay_left = join(work, ranks.size(), console);
    }
  });
  return done;
}

}  // namespace irdm::precompute
