// SPDX-License-Identifier: BSL-1.0
// Tables of command lines: what the program must answer to each, one row a line of
// tests/programs/cases/NAME.txt.
//
//   # A comment.
//   let learn = learn --trajectories 3  {learn} stands for it below; {a;b} in a command makes two rows
//   == NAME                             a new, empty folder for the rows that follow
//   file t.json = {"format": "x"}\n     a file in the folder; `copy scheme.json` takes one of inputs/
//   sh cp t.json u.json                 a line of the shell, which must end with 0; $nysalt is the program,
//                                       $source tests/programs, $faults what is preloaded to kill or to stop
//                                       it (faults/fail.cpp), $hdf5 whether it is built with HDF5, 1 or 0,
//                                       `$mpirun 3` starts three ranks: in tables named on_ranks.txt, which
//                                       are left out where there is no MPI
//   target m.json of scheme.json        the file that `text:` and `with:` write
//   @ {learn}                           what each command below begins with, until the next @ or ==
//   2 -0.02 | --step | positive         exit code, arguments, and what must be so
//   x2 0.02 | positive                  a row that the driver must find wrong
//   0 $ "$nysalt" list |cat | out: fpu  a line of the shell instead of arguments
//
// What must be so, each after " | ", on the same line or on the next, which then begins with "  |":
//
//   TEXT         is on the standard error        not: TEXT      is not
//   out: TEXT    is on the standard output       not out: TEXT  is not
//   first: TEXT  begins the standard output      width: N       no line of it has more columns
//   files: A B   the folder has these alone      holds F: TEXT  the file has the text
//   label: L     the name of this answer         same: L        prints the same but times; other: L not
//   golden: G TOL        prints golden/G.json, numbers within the relative tolerance, "~kind" for any value
//   schema: NAME         obeys the JSON Schema share/schemas/NAME.json
//   json: /a/0/b = /c    of the document printed; also != < > <= >=, `~ VALUE TOL` relative, `has TEXT`,
//                        `lacks TEXT`, `set A B C`. A place is L:/a of another answer;
//                        /rows[method=verlet]/error selects; /a# is a size; /a/*/b all; 2*/a is twice that.
//   with: /a = 1         before the command the target is written: its source with that member, signed again;
//                        `/a` alone removes it; text: TEXT has the target be that text
//   any err              whatever is said is right
//
// Exit code 0 says nothing on the standard error but what is named, and 2 is one line there which begins with
// "nysalt: ", nothing on the standard output, and a folder that stays as it was. NYSALT_RECORD=1 writes
// golden files.
#pragma once

#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

namespace nysalt::test {

/// What is wrong with the rows of a table of that text, a line each. Empty if they are as they must be.
std::vector<std::string> wrong_rows(const std::string& text, const std::string& name);

/// Every row is a check, of each table whose file the command line names after "--"; there must be one.
void run_tables_named();

}  // namespace nysalt::test
