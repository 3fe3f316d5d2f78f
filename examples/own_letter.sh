#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Letters of one's own in the program: words by their names, learned, kept in a file, and compared.
set -e
here=$(dirname "$0")
# [words]
nysalt learn --system "$here/plugins/cubic_well.hpp" --family word:tctctct --step 1 --horizon 20 \
  --output scheme.json >learned.txt
nysalt compare --system "$here/plugins/cubic_well.hpp" --methods word:tctctct,scheme.json,pefrl --steps 1 \
  --metric state --horizon 20 >compared.txt
# [/words]
head -n 2 learned.txt
# [parts]
nysalt compare --system "$here/plugins/bonds_and_charges.hpp" --methods word:kA0A0A0Ak,learned:word:kA0A0A0Ak \
  --steps 0.06 --metric state --horizon 2.4 --learn-horizon 2.4 --learn-trajectories 16 >parts.txt
# [/parts]

# Expected output:
# word:tctctct at step 1 for cubic_well(): usable, with a held-out loss 1.09 ± 0.039 times smaller than that of
#   equal steps, the best classical method of the same cost.
