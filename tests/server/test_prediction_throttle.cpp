#include "server/threads/prediction_throttle.hpp"
#include "tests/support/catch.hpp"

using irdm::PredictionThrottle;

TEST_CASE(
    "prediction throttle: rarer while steps take too long, each step again only after a good "
    "while") {
  PredictionThrottle throttle;
  CHECK(throttle.period() == 1);
  throttle.update(1000, 10);  // as many as may be
  CHECK(throttle.period() == 1);
  throttle.update(500, 5);
  CHECK(throttle.period() == 1);
  for (const int expected : {2, 4, 8, 8}) {
    throttle.update(1000, 100);
    CHECK(throttle.period() == expected);
  }
  int due = 0;
  for (int step = 0; step < 80; ++step) due += throttle.due(false) ? 1 : 0;
  CHECK(due == 10);
  for (const int expected : {4, 2, 1, 1}) {
    for (int second = 0; second < PredictionThrottle::kGood; ++second) {
      throttle.update(1000, 0);
    }
    CHECK(throttle.period() == expected);
  }
}

TEST_CASE("prediction throttle: neither good nor bad changes nothing") {
  PredictionThrottle throttle;
  throttle.update(1000, 100);
  for (int second = 0; second < 100; ++second) throttle.update(1000, 5);
  CHECK(throttle.period() == 2);
  for (int second = 0; second + 1 < PredictionThrottle::kGood; ++second) throttle.update(1000, 0);
  throttle.update(1000, 5);
  for (int second = 0; second + 1 < PredictionThrottle::kGood; ++second) throttle.update(1000, 0);
  CHECK(throttle.period() == 2);
  throttle.update(1000, 0);
  CHECK(throttle.period() == 1);
}

TEST_CASE("prediction throttle: a server that is always behind makes a model in each fourth step") {
  PredictionThrottle throttle;
  int due = 0;
  for (int step = 0; step < 80; ++step) due += throttle.due(true) ? 1 : 0;
  CHECK(due == 20);
  CHECK_FALSE(throttle.due(true));
  CHECK(throttle.due(false));
}
