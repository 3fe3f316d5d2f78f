// expect: nysalt: an own loss is a function of (start, finish, wanted), each a `phase_point<T, N>` of the
//   system's dimension N, and const, for any scalar T
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/losses/own_loss.hpp"
#include "nysalt/systems/henon_heiles.hpp"

#ifdef NYSALT_CONTROL
auto place = []<class T>(const nysalt::phase_point<T, 2>&, const nysalt::phase_point<T, 2>& finish,
                         const nysalt::phase_point<T, 2>& wanted) -> T { return finish.q[0] - wanted.q[0]; };
#else
// [mistake]
using state = nysalt::phase_point<double, 2>;
auto place = [](const state&, const state& finish, const state& wanted) { return finish.q[0] - wanted.q[0]; };
// [/mistake]
#endif

int main() { nysalt::own_error(nysalt::henon_heiles(), place); }
