// SPDX-License-Identifier: BSL-1.0
// Saved and resumed: a hundred trajectories go on from a file as if nothing had happened, noise included.
//
// Pendulums in a bath are run to the end at once, and a second time in two parts with a file between them:
// the second part by other threads, one trajectory at a time instead of side by side. Noise is a function of
// where it is used and has no state, so the file holds q, p, the force and the step, and nothing else.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "nysalt/nysalt.hpp"

using namespace nysalt;

// [file]
template <class Item>
void put(atomic_file& file, const Item& item) {
  file.write({reinterpret_cast<const char*>(&item), sizeof item});
}

/// The step, the number of trajectories, where each diverged (-1: nowhere), and their numbers, as they are in
/// memory. The file is there whole or not at all.
void write(const saved_runs& runs, const std::filesystem::path& path) {
  atomic_file file(path);
  put(file, runs.step);
  put(file, std::ssize(runs.diverged_at));
  for (const auto& at : runs.diverged_at) put(file, at.value_or(-1));
  for (const double number : runs.numbers) put(file, number);
  file.commit();
}

template <class Item>
Item get(std::istream& file) {
  Item item;
  if (file.read(reinterpret_cast<char*>(&item), sizeof item)) return item;
  throw std::runtime_error("the file of saved trajectories is cut off");
}

saved_runs read(const std::filesystem::path& path, std::int64_t numbers_of_each) {
  std::ifstream file(path, std::ios::binary);
  saved_runs runs;
  runs.step = get<std::int64_t>(file);
  const auto trajectories = get<std::int64_t>(file);
  for (std::int64_t m = 0; m < trajectories; ++m) {
    const auto at = get<std::int64_t>(file);
    runs.diverged_at.push_back(at < 0 ? std::nullopt : std::optional(at));
  }
  for (std::int64_t k = 0; k < numbers_of_each * trajectories; ++k) runs.numbers.push_back(get<double>(file));
  return runs;
}
// [/file]

int main() {
  constexpr std::int64_t trajectories = 100;
  constexpr std::int64_t end = 20'000;
  constexpr std::int64_t middle = 100 * steps_between_checks;  // cut here it is as if uncut
  const in_bath system(pendulum{}, bath::of_temperature(0.1, 0.5));
  const auto stepper = make_stepper(system, baoab{}, 0.1, counter_noise(7));
  const normal_around<1> starts({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.5, 0.5);
  const auto nothing = [](auto&&...) {};
  const std::filesystem::path path = "restart.saved";

  // [restart]
  using stepper_type = std::remove_const_t<decltype(stepper)>;
  using side_by_side = ensemble_run<pack<double>, stepper_type>;
  using one_by_one = ensemble_run<double, stepper_type>;
  side_by_side uncut(stepper, starts, 1, 0, trajectories);
  uncut.go_on(end, end, 0, nothing, nothing);

  side_by_side first_part(stepper, starts, 1, 0, trajectories);
  first_part.go_on(middle, middle, 0, nothing, nothing);
  write(first_part.save(), path);

  one_by_one second_part(stepper, starts, 1, 0, trajectories, read(path, 3));
  fmt::print("taken up at step {}\n", second_part.step());
  second_part.go_on(end, end, 0, nothing, nothing, {.threads = 2});
  // [/restart]

  const auto whole = uncut.save().numbers;
  const auto cut = second_part.save().numbers;
  fmt::print("at step {}: {} numbers, and as many equal to the last bit: {}\n", second_part.step(),
             whole.size(), whole == cut ? "yes" : "no");

  // With other noise in the second part they would not be: this is what is compared.
  const auto other_noise = make_stepper(system, baoab{}, 0.1, counter_noise(8));
  one_by_one other(other_noise, starts, 1, 0, trajectories, read(path, 3));
  other.go_on(end, end, 0, nothing, nothing);
  fmt::print("with another seed of the noise: {}\n", whole == other.save().numbers ? "yes" : "no");

  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  try {
    read(path, 3);
  } catch (const std::runtime_error& refusal) {
    fmt::print("half of the file: {}\n", refusal.what());
  }
}

// Expected output:
// taken up at step 6400
// at step 20000: 300 numbers, and as many equal to the last bit: yes
// with another seed of the noise: no
// half of the file: the file of saved trajectories is cut off
