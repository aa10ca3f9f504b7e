// All levels without details at once, at the valid texels of a tile: for geometry and appearance, with a face or without.
//
// They are one filter g that makes `factor` samples of each: with p + delay = factor k + s,
// x[p] = sum_j g[factor j + s] a[k - j], j from 0 to reach - 1.
//
// What includes this declares ll, upsampling, tiles, static_offset, texel_channels and their constants before.

#ifndef MUA_UPSAMPLE_HLSL
#define MUA_UPSAMPLE_HLSL

#define TILE 16
#define MAX_TAPS 42
#define MAX_SAMPLES MAX_TAPS // along a side of the part of ll that a tile needs, with any factor
#define BATCH 4 // channels of a row of texel_channels

// Of a tile's columns and a batch of channels, [sample of ll, column].
groupshared float4 upsampled[MAX_SAMPLES * TILE];

// The one before, round the edge.
uint olderSample(uint sample)
{
    return (sample == 0 ? size : sample) - 1;
}

float sampleAt(StructuredBuffer<uint> planes, uint start, uint column)
{
    return halfAt(planes[start + column / 2], column & 1);
}

// The newest sample of ll, before it is wrapped, that the texels of a row or column need; the older ones precede it.
uint newestSample(uint position)
{
    return (position + delay) / factor;
}

uint phase(uint position)
{
    return (position + delay) % factor;
}

// A batch of channels of a column of texels, in a row of ll.
float4 upsampleRow(uint4 planes, uint row, uint column)
{
    uint4 begins = (planes * size + row) * rowWords(size);
    uint older = newestSample(column) % size;
    uint tap = phase(column);
    float4 sum = 0;
    [loop]
    for (uint j = 0; j < reach; j++)
    {
        float4 samples = float4(sampleAt(ll, begins.x, older), sampleAt(ll, begins.y, older),
                                sampleAt(ll, begins.z, older), sampleAt(ll, begins.w, older));
        sum += upsampling[tap] * samples;
        tap += factor;
        older = olderSample(older);
    }
    return sum;
}

// The batch at a texel: `newest` is the place of its newest sample in the tile, `column` its own.
float4 upsampleColumn(uint newest, uint tap, uint column)
{
    float4 sum = 0;
    [loop]
    for (uint j = 0; j < reach; j++)
        sum += upsampling[factor * j + tap] * upsampled[(newest - j) * TILE + column];
    return sum;
}

// Column and row of a tile's first texel.
uint2 cornerOf(uint tile)
{
    return TILE * tiles[(TILE + 1) * tile];
}

// The newest sample of a tile's first row; reach - 1 older ones stand before it.
uint firstSample(uint tile)
{
    return newestSample(cornerOf(tile).y);
}

// Makes what a tile's columns of a batch of channels need; all threads of a group take part.
void loadBatch(uint tile, uint2 thread, uint first)
{
    uint4 planes = min(first + uint4(0, 1, 2, 3), channels - 1); // those beyond take part, and are not stored
    uint2 corner = cornerOf(tile);
    uint before = firstSample(tile);
    uint samples = newestSample(corner.y + TILE - 1) - before + reach;
    [loop]
    for (uint i = thread.y; i < samples; i += TILE)
    {
        uint row = (before + i + reach * size - (reach - 1)) % size;
        upsampled[i * TILE + thread.x] = upsampleRow(planes, row, corner.x + thread.x);
    }
}

// The batch at a thread's texel, without its static offset.
float4 batchAt(uint tile, uint2 thread)
{
    uint position = cornerOf(tile).y + thread.y;
    uint newest = newestSample(position) - firstSample(tile) + reach - 1;
    return upsampleColumn(newest, phase(position), thread.x);
}

// Of a row of a tile: its first valid texel; its valid columns as bits, then those in reach of expressions.
uint2 tileRow(uint tile, uint row)
{
    return tiles[(TILE + 1) * tile + 1 + row];
}

bool isIn(uint columns, uint column)
{
    return (columns >> column & 1) != 0;
}

uint texelOf(uint2 run, uint column)
{
    return run.x + countbits(run.y & ((1u << column) - 1));
}

// With the static offset; what is beyond the last channel is zero.
float4 withStatic(float4 values, uint texel, uint first)
{
    float4 whole = 0;
    [unroll]
    for (uint i = 0; i < BATCH; i++)
        if (first + i < channels)
            whole[i] = values[i] + stored(static_offset, static_offset_layout, (first + i) * texel_count + texel);
    return whole;
}

void writeTexel(uint texel, uint row, float4 values)
{
    texel_channels[row * texel_count + texel] = uint2(packBounded(values.xy), packBounded(values.zw));
}

#endif
