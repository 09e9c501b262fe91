#include <fstream>
#include <iostream>
#include <memory>
#include <optional>

#include "common/error.hpp"
#include "common/program/program.hpp"
#include "replay/command/command.hpp"
#include "replay/compare/comparison_json.hpp"
#include "replay/compare/comparison_text.hpp"
#include "replay/output/part_file.hpp"
#include "replay/report/comparison_html.hpp"

namespace irdm::replay {
namespace {

struct CompareOptions {
  std::filesystem::path a, b;
  std::optional<std::filesystem::path> json, html;
  std::vector<double> hand;  // mass, damping, stiffness; or empty
};

void write_text(const std::filesystem::path& path, const std::string& text) {
  PartFile file(path);
  std::ofstream stream(file.part(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw Error(file.part().string(), "cannot be written", "make room on the disk");
  file.finish();
}

perception::Hand hand_of(const CompareOptions& options) {
  if (options.hand.empty()) return {};
  return {options.hand[0], options.hand[1], options.hand[2]};
}

int compare(const CompareOptions& options) {
  const RunReader a(options.a);
  const RunReader b(options.b);
  const Comparison comparison = compare_runs(a, b);
  const Measures measures = measure_runs(a, b, comparison, hand_of(options));
  if (options.json) write_text(*options.json, comparison_json(comparison, measures));
  if (options.html) write_text(*options.html, comparison_html(comparison, measures));
  std::cout << comparison_table(comparison, measures) << std::flush;
  return 0;
}

}  // namespace

Command add_compare_command(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "Says how far two runs of the same interaction are apart");
  command->add_option("a", options->a, "Run file that --output wrote")->required();
  command->add_option("b", options->b, "Another one, of the same scene")->required();
  command->add_option("--json", options->json,
                      "File for all of it, frame by frame; must not exist");
  command->add_option("--html", options->html,
                      "File for a report with figures, to open in a browser; must not exist");
  command
      ->add_option("--hand", options->hand,
                   "Mass with the device's (kg), damping (N s/m) and stiffness (N/m) of the hand "
                   "that feels vibrations (default: 0.12 2 300)")
      ->expected(3)
      ->check(positive_number());
  return [options] { return compare(*options); };
}

}  // namespace irdm::replay
