#include <unistd.h>

#include <iostream>

#include "common/program/program.hpp"
#include "precompute/blas_kernel.hpp"
#include "precompute/precompute.hpp"

using namespace irdm;

int main(int argc, char** argv) {
  precompute::use_fast_blas_kernel(argv);
  CLI::App app("Computes the impulse responses of a soft object and writes its model file.",
               "irdm-precompute");
  std::string config_path;
  std::string output;
  std::string method;
  std::string storage;
  int threads = 0;
  app.add_option("config", config_path, "Configuration file (TOML)")->required();
  app.add_option("-o,--output", output, "Model file to write (HDF5)")->required();
  app.add_option("--method", method, "How R is obtained; overrides response.method")
      ->check(CLI::IsMember({"modal", "time-stepping"}));
  app.add_option("--storage", storage, "Form of R in the file; overrides response.storage")
      ->check(CLI::IsMember({"modal", "dense", "both"}));
  app.add_option("--threads", threads, "Threads to compute with (default: all cores)")
      ->check(CLI::Range(1, 1024));

  return run_program(app, argc, argv, [&] {
    precompute::PrecomputeConfig config = precompute::load_config(config_path);
    if (!method.empty()) config.response.method = precompute::method_from_word(method);
    if (!storage.empty()) config.response.storage = precompute::storage_from_word(storage);
    precompute::set_blas_threads(threads);
    config.threads = threads;
    const precompute::Console console{std::cout, ::isatty(STDOUT_FILENO) != 0};
    const precompute::Summary summary = precompute::precompute_model(config, output, console);
    console.line(output + ":\n" + precompute::format_summary(summary));
    return 0;
  });
}
