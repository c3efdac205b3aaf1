// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/memory.hpp"
#include "scenes/program/commands.hpp"
#include "scenes/program/commit.hpp"

int main(int argc, char** argv) {
    tesserae::scenes::return_large_memory();
    return tesserae::scenes::program(argc, argv, tesserae::scenes::kCommit);
}
