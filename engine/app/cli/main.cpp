// SPDX-License-Identifier: MIT
#include "engine/app/cli/command.h"

int main(int argc, char** argv) { return catena::app::run(argc, argv); }
