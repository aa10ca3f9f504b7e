using System;
using System.IO;

namespace Mua.Format
{
    /// <summary>
    /// The bytes of a deflate stream, the last of them alone: a decompressor that ends before the last byte never asks for it,
    /// and one that is not at its end asks for more.
    /// </summary>
    internal sealed class StreamSource : Stream
    {
        private readonly byte[] content;
        private readonly int end;
        private int at;
        private bool wantsMore;

        public StreamSource(byte[] content, int offset, int count)
        {
            this.content = content;
            at = offset;
            end = offset + count;
        }

        /// <summary>Whether all bytes were asked for, and no more.</summary>
        public bool IsUsedUp => at == end && !wantsMore;

        public override bool CanRead => true;

        public override bool CanSeek => false;

        public override bool CanWrite => false;

        public override long Length => throw new NotSupportedException();

        public override long Position
        {
            get => throw new NotSupportedException();
            set => throw new NotSupportedException();
        }

        public override int Read(byte[] buffer, int offset, int count)
        {
            int read = Math.Min(count, at < end - 1 ? end - 1 - at : end - at);
            wantsMore |= count > 0 && read == 0;
            Buffer.BlockCopy(content, at, buffer, offset, read);
            at += read;
            return read;
        }

        public override void Flush()
        {
        }

        public override long Seek(long offset, SeekOrigin origin)
        {
            throw new NotSupportedException();
        }

        public override void SetLength(long value)
        {
            throw new NotSupportedException();
        }

        public override void Write(byte[] buffer, int offset, int count)
        {
            throw new NotSupportedException();
        }
    }
}
