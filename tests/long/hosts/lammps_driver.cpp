// SPDX-License-Identifier: BSL-1.0
// Runs a script of LAMMPS with an exported fix: EXPORTED names the text, exported under the name `exported`.
// The LAMMPS of Debian 12 has no plug-ins, so that the fix is registered here.
#include <fmt/format.h>

// Debian 12's headers of LAMMPS ask for a function that Debian 12's fmt has no more.
namespace fmt {
template <class... Args, class S>
auto make_args_checked(const S&, Args&... args) {
  return make_format_args(args...);
}
}  // namespace fmt

#include EXPORTED
#include "lammps.h"
#include "library.h"
#include "modify.h"

int main(int, char** argv) {
  char name[] = "lmp", log[] = "-log", screen[] = "-screen", none[] = "none", file[] = "log";
  char* args[] = {name, log, file, screen, none};
  void* const handle = lammps_open_no_mpi(5, args, nullptr);
  auto* const lammps = static_cast<LAMMPS_NS::LAMMPS*>(handle);
  (*lammps->modify->fix_map)["nysalt/exported"] = LAMMPS_NS::make_fix_exported;
  lammps_file(handle, argv[1]);
  lammps_close(handle);
}
