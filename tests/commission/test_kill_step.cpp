#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "device_bridge/commission/kill_step.hpp"
#include "device_bridge/commission/step.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm::commission;
using namespace irdm::test;

namespace {

/// Answers what is given.
class Answers final : public Person {
 public:
  explicit Answers(std::deque<bool> answers) : answers_(std::move(answers)) {}
  void tell(const std::string&) override {}
  bool begins(const Step&) override { return false; }
  bool confirms(const std::string& question) override {
    asked += question + '\n';
    const bool answer = answers_.front();
    answers_.pop_front();
    return answer;
  }
  bool stops(int) override { return false; }

  std::string asked;

 private:
  std::deque<bool> answers_;
};

const std::vector<std::string> kPushes{"sleep", "600"};

}  // namespace

TEST_CASE("commission: a bridge is killed when the force is felt, and the person's word is timed") {
  Answers person({true, true});
  Measured measured;
  const StepRecord record = run_kill_step(kPushes, person, measured);
  CHECK(record.verdict == Verdict::kPassed);
  CHECK_THAT(record.words,
             ContainsSubstring("no force after") && ContainsSubstring("time to answer included"));
  CHECK(measured.stop_kill.value() >= 0.0);
  CHECK_THAT(person.asked, ContainsSubstring("pushes it up with 0.5 N") &&
                               ContainsSubstring("Is the force gone?"));
}

TEST_CASE("commission: a killed bridge whose force went on, or was none, does not pass") {
  Measured measured;
  Answers went_on({true, false});
  CHECK_THAT(run_kill_step(kPushes, went_on, measured).words,
             ContainsSubstring("the force went on"));
  Answers none({false});
  CHECK_THAT(run_kill_step(kPushes, none, measured).words, ContainsSubstring("there was no force"));
  CHECK_FALSE(measured.stop_kill);
}

TEST_CASE("commission: a bridge that ends before it is killed, or is not there, does not pass") {
  Measured measured;
  const TemporaryFolder folder;
  const std::string ended = (folder.path() / "ended").string();
  /// Answers once the program is about to end.
  struct Patient final : Person {
    explicit Patient(std::string file) : file_(std::move(file)) {}
    void tell(const std::string&) override {}
    bool begins(const Step&) override { return false; }
    bool confirms(const std::string&) override {
      return eventually([&] { return std::filesystem::exists(file_); });
    }
    bool stops(int) override { return false; }
    std::string file_;
  } patient(ended);
  CHECK_THAT(run_kill_step({"mkdir", ended}, patient, measured).words,
             ContainsSubstring("ended by itself"));
  const StepRecord record = run_kill_step({"/no/such/program"}, patient, measured);
  CHECK(record.verdict == Verdict::kFailed);
  CHECK_THAT(record.words, ContainsSubstring("cannot be started"));
}
