// A hand that is given row by row has the places of one that is given at once, and forgets what lies behind.
#include "pindrive/device/live_hand.hpp"

#include <cmath>

#include "check.hpp"

namespace device = pindrive::device;
using check::expect;

namespace {

void places_and_rows() {
  const device::Axis axis(0);
  device::LiveHand hand({1, {0.1, 0}, 1}, {0.01, 0.02}, axis);
  hand.add({1.1, {0.3, 0.1}, 0.5}, axis);
  expect(hand.begin() == 1 && hand.end() == 1.1 && hand.size() == 2, "rows are counted");
  expect(std::abs(hand.place(1).x - 0.03) < 1e-16 && std::abs(hand.place(1).y - 0.025) < 1e-16,
         "a place follows from the mean velocity");
  const device::Place middle = hand.path().position(1.05);
  expect(std::abs(middle.x - 0.0175) < 1e-16, "in between the velocity is linear");
  expect(std::abs(hand.touch(1).from(0.05).value - 0.75) < 1e-15, "so is the touch");
  expect(std::abs(hand.touch(2).from(0.05).value - 0.5625) < 1e-15,
         "its friction by a power of it");
  expect(hand.plate().times()[1] == 1.1 - 1 && hand.plate().across_axis().rows[1] == 0.1,
         "the plate has the time since the begin");
}

void rows_behind() {
  const device::Axis axis(0.3);
  device::LiveHand hand({0, {0.1, 0}, 1}, {0, 0}, axis), whole = hand;
  for (int i = 1; i <= 1000; ++i) {
    const device::LiveHand::Row row{i * 1e-3, {0.1 + 0.05 * std::sin(0.1 * i), 1e-3 * (i % 3)}, 1};
    hand.add(row, axis);
    whole.add(row, axis);
    hand.forget((i - 1.5) * 1e-3);
  }
  expect(hand.size() < 8 && whole.size() == 1001, "rows behind are forgotten");
  const device::Place one = hand.path().position(0.9985), other = whole.path().position(0.9985);
  expect(one.x == other.x && one.y == other.y, "the others remain to the bit");
  expect(hand.plate().along_axis().rows.back() == whole.plate().along_axis().rows.back() &&
             hand.begin() == 0,
         "with the velocity of the plate and the begin of all");

  std::vector<std::pair<device::LiveHand::Row, device::Place>> rows;
  rows.reserve(hand.size());
  for (std::size_t i = 0; i < hand.size(); ++i) rows.emplace_back(hand.row(i), hand.place(i));
  const device::LiveHand again(hand.begin(), rows, axis);
  expect(again.path().position(0.9985).x == one.x && again.plate().times() == hand.plate().times(),
         "a hand can be made from its rows");
}

}  // namespace

int main() {
  places_and_rows();
  rows_behind();
  return check::status();
}
