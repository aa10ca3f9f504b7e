// Generated from schemas/muaavatar.fbs by tools/gen_layout.py; do not edit.

namespace Mua.Format
{
    internal static class Layouts
    {
        public const string Identifier = "MUAV";

        public static readonly string[] ElementType = { "F32", "F16", "I8", "I32" };
        public static readonly string[] Packing = { "Plain", "Deflate", "Steps" };
        public static readonly string[] Axes = { "MetresYUpRightHanded" };
        public static readonly string[] RotationEncoding = { "SixD" };
        public static readonly string[] WindowOrder = { "NewestFirst" };

        public static readonly Layout Tensor = new Layout(
            new Field("shape", Kind.U32, vector: true, required: true),
            new Field("type", Kind.Enum, names: ElementType),
            new Field("data", Kind.U8, vector: true, required: true, align: 16),
            new Field("scale", Kind.F32, vector: true),
            new Field("packing", Kind.Enum, names: Packing));

        public static readonly Layout Skeleton = new Layout(
            new Field("names", Kind.Text, vector: true, required: true),
            new Field("parents", Kind.Table, required: true, table: Tensor),
            new Field("bind_rotations", Kind.Table, required: true, table: Tensor),
            new Field("bind_translations", Kind.Table, required: true, table: Tensor),
            new Field("bind_inverse", Kind.Table, required: true, table: Tensor),
            new Field("root", Kind.U32),
            new Field("translated", Kind.Table, table: Tensor));

        public static readonly Layout PoseEncoding = new Layout(
            new Field("joints", Kind.Table, required: true, table: Tensor),
            new Field("rotation", Kind.Enum, names: RotationEncoding),
            new Field("order", Kind.Enum, names: WindowOrder),
            new Field("window", Kind.U32),
            new Field("rate", Kind.F32),
            new Field("heading", Kind.Flag),
            new Field("mean", Kind.Table, required: true, table: Tensor),
            new Field("scale", Kind.Table, required: true, table: Tensor),
            new Field("translated", Kind.Table, table: Tensor),
            new Field("components", Kind.Table, required: true, table: Tensor),
            new Field("ranges", Kind.Table, required: true, table: Tensor),
            new Field("margins", Kind.Table, required: true, table: Tensor));

        public static readonly Layout Template = new Layout(
            new Field("faces", Kind.Table, required: true, table: Tensor),
            new Field("uv", Kind.Table, required: true, table: Tensor),
            new Field("uv_faces", Kind.Table, required: true, table: Tensor),
            new Field("skin_indices", Kind.Table, required: true, table: Tensor),
            new Field("skin_weights", Kind.Table, required: true, table: Tensor));

        public static readonly Layout Level = new Layout(
            new Field("blocks", Kind.U8, vector: true, required: true));

        public static readonly Layout Texels = new Layout(
            new Field("size", Kind.U32),
            new Field("texels", Kind.Table, required: true, table: Tensor),
            new Field("triangles", Kind.Table, required: true, table: Tensor),
            new Field("barycentrics", Kind.Table, required: true, table: Tensor),
            new Field("listed", Kind.Table, table: Tensor),
            new Field("one_sided", Kind.U8, vector: true),
            new Field("length", Kind.F32),
            new Field("levels", Kind.Table, vector: true, required: true, table: Level));

        public static readonly Layout Wavelet = new Layout(
            new Field("name", Kind.Text, required: true),
            new Field("levels", Kind.U32),
            new Field("rec_lo", Kind.F64, vector: true, required: true),
            new Field("rec_hi", Kind.F64, vector: true, required: true));

        public static readonly Layout Layer = new Layout(
            new Field("weight", Kind.Table, required: true, table: Tensor),
            new Field("bias", Kind.Table, required: true, table: Tensor));

        public static readonly Layout Coarse = new Layout(
            new Field("mlp", Kind.Table, vector: true, required: true, table: Layer),
            new Field("mean", Kind.Table, required: true, table: Tensor),
            new Field("basis", Kind.Table, required: true, table: Tensor));

        public static readonly Layout DetailBand = new Layout(
            new Field("mean", Kind.Table, required: true, table: Tensor),
            new Field("h", Kind.Table, required: true, table: Tensor),
            new Field("w", Kind.Table, required: true, table: Tensor));

        public static readonly Layout Branch = new Layout(
            new Field("mlp", Kind.Table, vector: true, required: true, table: Layer),
            new Field("ll_mean", Kind.Table, required: true, table: Tensor),
            new Field("ll_basis", Kind.Table, required: true, table: Tensor),
            new Field("details", Kind.Table, vector: true, required: true, table: DetailBand),
            new Field("static_offset", Kind.Table, required: true, table: Tensor));

        public static readonly Layout Clip = new Layout(
            new Field("name", Kind.Text, required: true),
            new Field("rate", Kind.F32),
            new Field("rotations", Kind.Table, required: true, table: Tensor),
            new Field("translation", Kind.Table, required: true, table: Tensor),
            new Field("translations", Kind.Table, table: Tensor),
            new Field("expressions", Kind.Table, table: Tensor));

        public static readonly Layout Surface = new Layout(
            new Field("runs", Kind.U8, vector: true, required: true),
            new Field("strips", Kind.Table, required: true, table: Tensor));

        public static readonly Layout Expressions = new Layout(
            new Field("names", Kind.Text, vector: true, required: true),
            new Field("starts", Kind.Table, required: true, table: Tensor),
            new Field("vertices", Kind.Table, required: true, table: Tensor),
            new Field("offsets", Kind.Table, required: true, table: Tensor),
            new Field("gains", Kind.Table, table: Tensor),
            new Field("rules", Kind.Table, table: Tensor));

        public static readonly Layout Avatar = new Layout(
            new Field("version_major", Kind.U16),
            new Field("version_minor", Kind.U16),
            new Field("crc32", Kind.U32),
            new Field("axes", Kind.Enum, names: Axes),
            new Field("name", Kind.Text, required: true),
            new Field("producer", Kind.Text, required: true),
            new Field("notes", Kind.Text, required: true),
            new Field("skeleton", Kind.Table, required: true, table: Skeleton),
            new Field("encoding", Kind.Table, required: true, table: PoseEncoding),
            new Field("template", Kind.Table, required: true, table: Template),
            new Field("texels", Kind.Table, required: true, table: Texels),
            new Field("wavelet", Kind.Table, required: true, table: Wavelet),
            new Field("coarse", Kind.Table, required: true, table: Coarse),
            new Field("geometry", Kind.Table, required: true, table: Branch),
            new Field("appearance", Kind.Table, required: true, table: Branch),
            new Field("clips", Kind.Table, vector: true, required: true, table: Clip),
            new Field("bounds", Kind.Table, required: true, table: Tensor),
            new Field("thumbnail", Kind.U8, vector: true, required: true),
            new Field("surface", Kind.Table, table: Surface),
            new Field("stages", Kind.U32, vector: true),
            new Field("expressions", Kind.Table, table: Expressions));

        public static readonly Layout Root = Avatar;
    }
}
