/// How the links make one force: the proxy chain, or one of the baselines that the paper compares it with (haptics/chain/baseline.h).
#pragma once

namespace catena::exchange {

enum class CouplingMethod { chain, pipe, balance, closest, linear };

}  // namespace catena::exchange
