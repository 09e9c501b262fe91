#include "precompute/columns/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "common/response/modal_response.hpp"

namespace irdm::precompute {
namespace {

using ColumnFiles = std::vector<std::unique_ptr<ColumnFileReader>>;

void check_same(const ColumnFileReader& first, const ColumnFileReader& part) {
  const ColumnFileHeader& a = first.header();
  const ColumnFileHeader& b = part.header();
  const auto differs = [&](const std::string& in) {
    throw Error(part.name(), "has " + in + " than " + first.name(),
                "give parts that were made from one configuration by one version of the program");
  };
  if (a.description != b.description) differs("another mesh, material or time axis");
  if (a.settings != b.settings || a.centrifugal != b.centrifugal || a.gravity != b.gravity) {
    differs("other settings");
  }
  if (a.precision != b.precision || a.steps != b.steps ||
      a.degrees_of_freedom != b.degrees_of_freedom) {
    differs("other numbers");
  }
}

void check_complete(const ColumnFiles& parts) {
  int next = 0;
  const auto missing = [](const ColumnFileReader& part, int from, int to) {
    throw Error(part.name(), "columns " + to_text(ColumnRange{from, to}) + " are in no part",
                "make them with --columns " + to_text(ColumnRange{from, to}));
  };
  for (const auto& part : parts) {
    const ColumnRange& range = part->header().range;
    if (range.begin < next) {
      throw Error(
          part->name(),
          "has columns from " + std::to_string(range.begin) + " on, which another part has too",
          "leave one of them out");
    }
    if (range.begin > next) missing(*part, next, range.begin);
    next = range.end;
  }
  const int all = parts.front()->header().degrees_of_freedom;
  if (next < all) missing(*parts.back(), next, all);
}

ColumnFiles open_parts(const std::vector<std::filesystem::path>& paths) {
  ColumnFiles parts;
  for (const auto& path : paths) parts.push_back(std::make_unique<ColumnFileReader>(path));
  for (const auto& part : parts) check_same(*parts.front(), *part);
  std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
    return a->header().range.begin < b->header().range.begin;
  });
  check_complete(parts);
  return parts;
}

// Calls visit(b, values) for each column in order, values being (T, 3n) floats or doubles.
template <typename Visit>
void for_each_column(const ColumnFiles& parts, const Visit& visit) {
  for (const auto& part : parts) {
    const ColumnFileHeader& header = part->header();
    part->rewind();
    for (int b = header.range.begin; b < header.range.end; ++b) {
      const void* bytes = part->next().data();
      if (header.precision == Precision::kSingle) {
        visit(b, static_cast<const float*>(bytes));
      } else {
        visit(b, static_cast<const double*>(bytes));
      }
    }
  }
}

// Of the driving point of one column: R[s](b, b) over s.
struct PartPeak {
  double peak = 0.0;
  double tail = 0.0;  // in the last tenth of the steps
};

template <typename Scalar>
PartPeak driving_point(int b, const Scalar* values, const ColumnFileHeader& header) {
  PartPeak point;
  const int tail = header.steps - (header.steps + 9) / 10;
  for (int s = 0; s < header.steps; ++s) {
    const auto at =
        static_cast<std::size_t>(s) * static_cast<std::size_t>(header.degrees_of_freedom);
    const double size = std::abs(static_cast<double>(values[at + static_cast<std::size_t>(b)]));
    point.peak = std::max(point.peak, size);
    if (s >= tail) point.tail = std::max(point.tail, size);
  }
  return point;
}

// The next columns of a part, one below the other.
template <typename Scalar>
RowMatrix<Scalar> next_columns(ColumnFileReader& part, int count) {
  const ColumnFileHeader& header = part.header();
  RowMatrix<Scalar> columns(count * header.steps, header.degrees_of_freedom);
  for (int p = 0; p < count; ++p) {
    const std::span<const std::uint8_t> bytes = part.next();
    std::memcpy(columns.row(p * header.steps).data(), bytes.data(), bytes.size());
  }
  return columns;
}

// Every part has the columns of loads on the whole body, after its own; those of the first are
// taken.
template <typename Scalar>
void copy_loads(ColumnFileReader& part, ModelFileWriter& writer) {
  const ColumnFileHeader& header = part.header();
  if (!header.centrifugal && !header.gravity) return;
  part.rewind();
  for (int b = header.range.begin; b < header.range.end; ++b) part.next();
  if (header.centrifugal) {
    writer.write_dense_centrifugal(next_columns<Scalar>(part, kSpinProducts).data());
  }
  if (header.gravity) {
    writer.write_dense_gravity(next_columns<Scalar>(part, kGravityColumns).data());
  }
}

}  // namespace

double assemble(const std::vector<std::filesystem::path>& paths,
                const std::filesystem::path& output, const std::filesystem::path& temporary,
                const Console& console) {
  const ColumnFiles parts = open_parts(paths);
  const ColumnFileHeader& header = parts.front()->header();
  const Model model = read_description(
      hdf5::File::from_image(header.description, parts.front()->name() + " (description)"));
  if (model.degrees_of_freedom() != header.degrees_of_freedom || model.steps != header.steps) {
    throw Error(parts.front()->name(), "does not fit its own description", "make it again");
  }
  ModelFileWriter writer(output, temporary);
  writer.write_description(model);
  writer.begin_dense(header.degrees_of_freedom, header.steps, header.precision);
  Progress progress(console, "writing R", header.degrees_of_freedom);
  double left = 0.0;
  for_each_column(parts, [&](int b, const auto* values) {
    writer.write_dense_column(b, values);
    const PartPeak point = driving_point(b, values, header);
    if (point.peak > 0.0) left = std::max(left, point.tail / point.peak);
    progress.update(b + 1);
  });
  if (header.precision == Precision::kSingle) {
    copy_loads<float>(*parts.front(), writer);
  } else {
    copy_loads<double>(*parts.front(), writer);
  }
  writer.commit();
  return left;
}

}  // namespace irdm::precompute
