#include <algorithm>
#include <random>
#include <vector>

#include "simulation/step/work_ledger.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

struct Shown {
  Vector3 place;
  Vector3 force;
};

// A hand on a straight way, so that what is known of two steps says where it was between them.
std::vector<Shown> straight(Random& random, std::size_t count) {
  const Vector3 way = anywhere(random, 1e-3);
  std::vector<Shown> shown(count);
  for (std::size_t k = 0; k < count; ++k) {
    shown[k] = {way * static_cast<double>(k) * (k + 1.0), anywhere(random, 3.0)};
  }
  return shown;
}

double work_of(const std::vector<Shown>& shown) {
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < shown.size(); ++k) {
    sum += shown[k].force.dot(shown[k + 1].place - shown[k].place);
  }
  return sum;
}

}  // namespace

TEST_CASE("work ledger: in whatever order steps are told, the work is the same") {
  Random random(5);
  for (int round = 0; round < 100; ++round) {
    const std::vector<Shown> shown = straight(random, 20);
    std::vector<std::size_t> order(shown.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    if (round > 0) std::shuffle(order.begin() + 1, order.end(), random);
    WorkLedger ledger;
    ledger.clear();
    double work = 0.0;
    for (const std::size_t k : order) {
      work += ledger.tell(k + 1, shown[k].place);
      work += ledger.show(k + 1, shown[k].force);
      CHECK(ledger.tell(k + 1, Vector3::Zero()) == 0.0);
    }
    CHECK(work == Approx(work_of(shown)).margin(1e-12));
  }
}

TEST_CASE(
    "work ledger: of a way over steps that nothing was told of a force has the share of one") {
  WorkLedger ledger;
  ledger.clear();
  CHECK(ledger.tell(1, Vector3::Zero()) == 0.0);
  CHECK(ledger.show(1, Vector3(2, 0, 0)) == 0.0);
  CHECK(ledger.tell(5, Vector3(0.04, 0, 0)) == Approx(0.02));
  // A late one lies on the straight way, wherever it is told to be.
  CHECK(ledger.tell(2, Vector3(0.03, 1.0, 0)) == Approx(0.06 - 0.02));
  CHECK(ledger.of(2, Vector3(3, 0, 0)) == Approx(0.01));
  CHECK(ledger.show(2, Vector3(3, 0, 0)) == Approx(0.01));
  CHECK(ledger.tell(3, Vector3(-9, 0, 0)) == Approx(-0.01));
}

TEST_CASE("work ledger: what is too long ago is left as it is") {
  WorkLedger ledger;
  ledger.clear();
  ledger.tell(1, Vector3::Zero());
  ledger.show(1, Vector3(1, 0, 0));
  CHECK(ledger.tell(1 + WorkLedger::kKept, Vector3(1, 0, 0)) == 0.0);
  CHECK(ledger.tell(1, Vector3::Zero()) == 0.0);
  CHECK(ledger.show(1, Vector3(9, 0, 0)) == 0.0);
}
