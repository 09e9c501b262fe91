#include "common/program/program.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <new>

#include "common/quoted.hpp"

namespace irdm {
namespace {

constexpr int kFailure = 1;
constexpr int kWrongUsage = 2;

int complain(const std::string& program, std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::cerr << program << ": error: " << text << std::endl;
  return kFailure;
}

}  // namespace

CLI::Validator positive_number() {
  const auto check = [](const std::string& text) {
    double value = 0.0;
    const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0;
    return good ? std::string() : in_quotes(text) + " is not a finite number above 0";
  };
  return {check, "POSITIVE", "positive_number"};
}

int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  app.set_version_flag("--version", app.get_name() + " " + IRDM_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongUsage;
  }
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return complain(app.get_name(), "not enough memory; use a smaller model or free memory");
  } catch (const std::exception& error) {
    return complain(app.get_name(), error.what());
  }
}

}  // namespace irdm
