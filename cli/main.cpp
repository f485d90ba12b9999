#include <malloc.h>

#include "cli/verb.hpp"

int main(int argc, char** argv) {
    // Images come and go in megabytes: given back to the system each time, they cost a page fault for every 4 KiB when
    // they come again (half of the time of prefiltering a 256² cube with a cosine).
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    return nacre::cli::runCommand(argc, argv);
}
