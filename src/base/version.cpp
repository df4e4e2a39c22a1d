#include "samestep/version.h"

namespace samestep {

std::string_view version() { return SAMESTEP_VERSION; }

std::string_view builtScalars() { return SAMESTEP_BUILT_SCALARS; }

std::string_view compiler() { return SAMESTEP_COMPILER; }

}  // namespace samestep
