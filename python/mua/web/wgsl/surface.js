// Generated from python/mua/player/shaders/surface.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const SurfaceVert = {
  ...{"stage":"vert","entry":"SurfaceVert","buffers":[{"name":"splats","binding":0,"read_only":true,"scalar":"uint","stride":16},{"name":"ring_starts","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"ring","binding":2,"read_only":true,"scalar":"uint","stride":8}],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":true},{"name":"camera","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"color","offset":80,"scalar":"float","shape":[4],"strides":[4],"used":false},{"name":"first_splat","offset":96,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":3,"threads":[1,1,1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)camera_0:vec4f,@align(16)color_0:vec4f,@align(16)first_splat_0:u32,};
@binding(3)@group(0)var<uniform>Constants_0:Constants;
@binding(0)@group(0)var<storage,read>splats_0:array<vec4u>;
@binding(1)@group(0)var<storage,read>ring_starts_0:array<u32>;
@binding(2)@group(0)var<storage,read>ring_0:array<vec2u>;
struct SurfaceVaryings_0{@builtin(position)position_0:vec4f,@location(0)normal_0:vec3f,@location(1)toCamera_0:vec3f,};
fn surfaceVaryings_0(a:vec3f,b:vec3f,c:vec3f,d:mat4x4f)->SurfaceVaryings_0{var e=c-a;var f=vec4f(a,1f)*d;var g=vec4f(a-e*vec3f(0.01f/max(length(e),1e-20f)),1f)*d;var h:SurfaceVaryings_0;var i=f.w;h.position_0=vec4f(f.xy,i*g.z/max(g.w,1e-20f),i);h.normal_0=b/vec3f(max(length(b),1e-20f));h.toCamera_0=e;return h;}
fn surfaceSplat_0(a:u32)->vec3f{return bitcast<vec3f>(splats_0[2*a].xyz);}
fn surfaceTexelNormal_0(a:u32,b:u32)->vec3f{var c=surfaceSplat_0(b+a);var d=vec3f();var e=ring_starts_0[a+1u];var f=ring_starts_0[a];var g=d;for(;f<e;){var h=g+cross(surfaceSplat_0(b+ring_0[f].x)-c,surfaceSplat_0(b+ring_0[f].y)-c);f=f+1u;g=h;}return g;}
@vertex fn SurfaceVert(@builtin(vertex_index)a:u32)->SurfaceVaryings_0{return surfaceVaryings_0(surfaceSplat_0(Constants_0.first_splat_0+a),surfaceTexelNormal_0(a,Constants_0.first_splat_0),Constants_0.camera_0.xyz,mat4x4f(Constants_0.view_projection_0.data_0[0][0],Constants_0.view_projection_0.data_0[1][0],Constants_0.view_projection_0.data_0[2][0],Constants_0.view_projection_0.data_0[3][0],Constants_0.view_projection_0.data_0[0][1],Constants_0.view_projection_0.data_0[1][1],Constants_0.view_projection_0.data_0[2][1],Constants_0.view_projection_0.data_0[3][1],Constants_0.view_projection_0.data_0[0][2],Constants_0.view_projection_0.data_0[1][2],Constants_0.view_projection_0.data_0[2][2],Constants_0.view_projection_0.data_0[3][2],Constants_0.view_projection_0.data_0[0][3],Constants_0.view_projection_0.data_0[1][3],Constants_0.view_projection_0.data_0[2][3],Constants_0.view_projection_0.data_0[3][3]));}`,
};

/** @type {import("../shader.js").Shader} */
export const SurfaceFrag = {
  ...{"stage":"frag","entry":"SurfaceFrag","buffers":[],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":false},{"name":"camera","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":false},{"name":"color","offset":80,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"first_splat","offset":96,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":3,"threads":[1,1,1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)camera_0:vec4f,@align(16)color_0:vec4f,@align(16)first_splat_0:u32,};
@binding(3)@group(1)var<uniform>Constants_0:Constants;
struct SurfaceVaryings_0{position_0:vec4f,normal_0:vec3f,toCamera_0:vec3f,};
fn surfaceShade_0(a:SurfaceVaryings_0,b:vec3f)->vec3f{var c=dot(normalize(a.normal_0),normalize(a.toCamera_0));return b*vec3f(0.28f+0.72f*abs(c))*vec3f(mix(1f,0.45f,saturate(-c/0.25f)));}
struct pixelOutput_0{@location(0)output_0:vec4f,};
struct pixelInput_0{@location(0)normal_1:vec3f,@location(1)toCamera_1:vec3f,};
@fragment fn SurfaceFrag(a:pixelInput_0,@builtin(position)b:vec4f)->pixelOutput_0{var c=SurfaceVaryings_0(b,a.normal_1,a.toCamera_1);var d=pixelOutput_0(vec4f(surfaceShade_0(c,Constants_0.color_0.xyz),1f));return d;}`,
};
