// SPDX-License-Identifier: BSL-1.0
// Members of families by the parameters of the struct that describes the family.
#pragma once

#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"

namespace nysalt::test {

/// The member of a family at theta.
template <Family F>
method member_at(const F& family, const detail::parameters_of<F>& theta) {
  return member(family, {theta.begin(), theta.end()});
}

/// The member of a family at its start.
template <Family F>
method start_of() {
  return member_at(F(), F::start());
}

/// Two stages [li_lu_tao_ye_2023] in a bath.
inline family two_stages_in(placement where) { return thermostatted(family(nystrom()), where); }

}  // namespace nysalt::test
