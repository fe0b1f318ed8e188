// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/guardian.h"

int main(int argc, char** argv) {
  return vitrine::acquisition::guard(argc, argv);
}
