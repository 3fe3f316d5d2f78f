// SPDX-License-Identifier: BSL-1.0
#include "models.hpp"

namespace nysalt::test {

std::vector<tabulated> methods_as_data(draws& random) {
  std::vector<tabulated> all;
  for_each<methods>([&]<class M>() { all.emplace_back(any_method<M>(random)); });
  return all;
}

}  // namespace nysalt::test
