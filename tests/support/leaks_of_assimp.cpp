// SPDX-License-Identifier: Apache-2.0
// Lets the leak detector ignore memory that Assimp leaks when it reads a damaged FBX file. A server
// does not keep this memory, because the process that imports a file ends after the import.

// The leak detector calls this function to get the rules for leaks that it ignores. In these
// programs, only Assimp calls inflateInit2_().
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp\nleak:inflateInit2_\n";
}
