// Exclusive prefix sum over the 256 threads of a group (Hillis and Steele 1986, https://doi.org/10.1145/7902.7903).
// A file that scans another type than uint defines SCAN_TYPE before it includes this one.

#ifndef MUA_SCAN_HLSL
#define MUA_SCAN_HLSL

#ifndef SCAN_TYPE
#define SCAN_TYPE uint
#endif

#define SCAN_THREADS 256

groupshared SCAN_TYPE scanned[SCAN_THREADS];

// The sum of the values of the threads below this one, and of all; every thread of the group must call it.
SCAN_TYPE exclusiveScan(uint thread, SCAN_TYPE value, out SCAN_TYPE total)
{
    scanned[thread] = value;
    GroupMemoryBarrierWithGroupSync();
    [unroll]
    for (uint reach = 1; reach < SCAN_THREADS; reach *= 2)
    {
        SCAN_TYPE sum = scanned[thread];
        if (thread >= reach)
            sum += scanned[thread - reach];
        GroupMemoryBarrierWithGroupSync();
        scanned[thread] = sum;
        GroupMemoryBarrierWithGroupSync();
    }
    total = scanned[SCAN_THREADS - 1];
    SCAN_TYPE before = scanned[thread] - value;
    GroupMemoryBarrierWithGroupSync(); // a second scan may overwrite
    return before;
}

#endif
