// SPDX-License-Identifier: MIT
// Compiles only the precompiled header (precompiled.cmake).
