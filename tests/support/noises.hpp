// SPDX-License-Identifier: BSL-1.0
// Sources of noise that only tests need.
#pragma once

#include <vector>

#include "nysalt/lanes.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt::test {

/// Fresh noise, also for states that carry derivatives: it has none. If it does not draw freely it stands for
/// a path, with numbers of its own for each letter.
template <bool DrawsFreely>
class lifted_noise {
 public:
  static constexpr bool is_memoryless = DrawsFreely;
  explicit lifted_noise(std::uint64_t seed) : source_(seed) {}

  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    draw(xi, [&](auto& numbers) { source_.normals(at, numbers); });
  }
  template <class T, int N>
  void halving(const noise_place& at, vector<T, N>& zeta) const {
    draw(zeta, [&](auto& numbers) { source_.halving(at, numbers); });
  }

 private:
  static void draw(auto& x, const auto& f) { f(x); }
  template <int K, int N>
  static void draw(vector<dual<double, K>, N>& x, const auto& f) {
    vector<double, N> numbers(x.size());
    f(numbers);
    x = numbers.template cast<dual<double, K>>();
  }
  counter_noise source_;
};
using fresh_noise = lifted_noise<true>;
using noise_of_a_path = lifted_noise<false>;
static_assert(NoiseSource<fresh_noise> && NoiseSource<noise_of_a_path>);

/// What was drawn of a source, in its order.
struct drawn_noise {
  std::vector<noise_place> normals;
  std::vector<noise_place> halves;
};

/// Fresh noise, or that of a path, which notes what is drawn. Refers to the notes.
template <bool DrawsFreely>
class noted_noise {
 public:
  static constexpr bool is_memoryless = DrawsFreely;
  explicit noted_noise(drawn_noise& notes) : notes_(&notes), source_(1) {}

  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    notes_->normals.push_back(at);
    source_.normals(at, xi);
  }
  template <class T, int N>
  void halving(const noise_place& at, vector<T, N>& zeta) const {
    notes_->halves.push_back(at);
    source_.halving(at, zeta);
  }

 private:
  drawn_noise* notes_;
  counter_noise source_;
};

}  // namespace nysalt::test
