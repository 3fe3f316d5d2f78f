// SPDX-License-Identifier: BSL-1.0
// The end of the process while a thread still computes. C++ would destroy its static objects, oneTBB's among
// them, under the feet of that thread, and the process would be aborted; so it ends without that.
#pragma once

namespace nysalt::python {

/// While it lives, a computation is under way.
class under_way {
 public:
  under_way();
  ~under_way();
  under_way(const under_way&) = delete;
  under_way& operator=(const under_way&) = delete;
};

/// From now on: when Python has ended, and with computations under way, the process leaves with its own exit
/// status and with C's standard streams written, but without what else was to be done at its exit.
void leave_from_computations();

}  // namespace nysalt::python
