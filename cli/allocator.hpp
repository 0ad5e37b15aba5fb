// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace exactcsg::cli {

// Memory asked for from now on comes in huge pages where the system gives them unasked. Clearing a
// few of them takes longer than a small model, so that the command starts without.
void use_huge_pages();

}  // namespace exactcsg::cli
