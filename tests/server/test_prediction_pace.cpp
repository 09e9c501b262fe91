#include <catch2/catch.hpp>

#include "server/threads/prediction_pace.hpp"

using irdm::PredictionPace;

TEST_CASE("prediction pace: rarer while steps are late, each step again only after a good while") {
  PredictionPace pace;
  CHECK(pace.period() == 1);
  pace.look(1000, 10);  // as many as may be
  CHECK(pace.period() == 1);
  for (const int expected : {2, 4, 8, 8}) {
    pace.look(900, 100);
    CHECK(pace.period() == expected);
  }
  int due = 0;
  for (std::uint64_t step = 0; step < 80; ++step) due += pace.due(step) ? 1 : 0;
  CHECK(due == 10);
  for (const int expected : {4, 2, 1, 1}) {
    for (int second = 0; second < PredictionPace::kGood; ++second) {
      pace.look(1000, 0);
    }
    CHECK(pace.period() == expected);
  }
}

TEST_CASE("prediction pace: neither good nor bad changes nothing") {
  PredictionPace pace;
  pace.look(900, 100);
  for (int second = 0; second < 100; ++second) pace.look(1000, 5);
  CHECK(pace.period() == 2);
  for (int second = 0; second + 1 < PredictionPace::kGood; ++second) pace.look(1000, 0);
  pace.look(1000, 5);
  for (int second = 0; second + 1 < PredictionPace::kGood; ++second) pace.look(1000, 0);
  CHECK(pace.period() == 2);
  pace.look(1000, 0);
  CHECK(pace.period() == 1);
}
