#pragma once

namespace opentmcl::app {

/// Whether messages on stderr may have colours: it is a terminal that knows them, and the environment does not say
/// NO_COLOR (https://no-color.org).
bool stderr_has_colours();

}  // namespace opentmcl::app
