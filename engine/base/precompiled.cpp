// Compiles only the precompiled header (precompiled.cmake).
