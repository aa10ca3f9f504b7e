// Exclusive prefix sum over the threads of a group: rows of 16 first, then the rows' sums. Three barriers, since they
// cost more than the sums of the few threads between them.

#ifndef MUA_SCAN_HLSL
#define MUA_SCAN_HLSL

#define SCAN_THREADS 256
#define SCAN_ROW 16
#define SCAN_ROWS (SCAN_THREADS / SCAN_ROW)

groupshared uint scanned[SCAN_THREADS + SCAN_ROWS]; // a word between rows, so that they lie in different banks
groupshared uint rowStarts[SCAN_ROWS];
groupshared uint scanTotal;

// Where a thread's value lies in `scanned`.
uint scanPlace(uint thread)
{
    return thread + thread / SCAN_ROW;
}

// The sum of the values of the threads below this one, and of all; every thread of the group must call it.
uint exclusiveScan(uint thread, uint value, out uint total)
{
    scanned[scanPlace(thread)] = value;
    GroupMemoryBarrierWithGroupSync();
    uint steps = thread < SCAN_ROWS ? SCAN_ROW : 0; // known at run time alone, so that the others' loop is skipped
    uint sum = 0;
    uint i;
    [loop]
    for (i = 0; i < steps; i++)
    {
        uint place = (SCAN_ROW + 1) * thread + i;
        uint next = scanned[place];
        scanned[place] = sum;
        sum += next;
    }
    if (thread < SCAN_ROWS)
        rowStarts[thread] = sum;
    GroupMemoryBarrierWithGroupSync();
    steps = thread == 0 ? SCAN_ROWS : 0;
    sum = 0;
    [loop]
    for (i = 0; i < steps; i++)
    {
        uint next = rowStarts[i];
        rowStarts[i] = sum;
        sum += next;
    }
    if (thread == 0)
        scanTotal = sum;
    GroupMemoryBarrierWithGroupSync(); // a next scan writes only what its own thread reads from here on, up to its first
    total = scanTotal;
    return scanned[scanPlace(thread)] + rowStarts[thread / SCAN_ROW];
}

#endif
