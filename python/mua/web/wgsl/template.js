// Generated from python/mua/player/shaders/template.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const TemplateVert = {
  ...{"stage":"vert","entry":"TemplateVert","buffers":[{"name":"vertex_dq","binding":0,"read_only":true,"scalar":"float","stride":16},{"name":"mesh","binding":1,"read_only":true,"scalar":"float","stride":4}],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":true},{"name":"camera","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"color","offset":80,"scalar":"float","shape":[4],"strides":[4],"used":false}],"constants_binding":2,"threads":[1,1,1]},
  code: `@binding(0)@group(0)var<storage,read>vertex_dq_0:array<vec4f>;
@binding(1)@group(0)var<storage,read>mesh_0:array<f32>;
struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)camera_0:vec4f,@align(16)color_0:vec4f,};
@binding(2)@group(0)var<uniform>Constants_0:Constants;
fn quaternionRotate_0(a:vec4f,b:vec3f)->vec3f{var c=a.yzw;var d=vec3f(2f)*cross(c,b);return b+vec3f(a.x)*d+cross(c,d);}
fn quaternionConjugate_0(a:vec4f)->vec4f{return vec4f(a.x,vec3f(0)-a.yzw);}
fn quaternionMultiply_0(a:vec4f,b:vec4f)->vec4f{var c=a.x;var d=b.x;var e=a.yzw;var f=b.yzw;return vec4f(c*d-dot(e,f),vec3f(c)*f+vec3f(d)*e+cross(e,f));}
fn dualTransform_0(a:vec4f,b:vec4f,c:vec3f)->vec3f{return quaternionRotate_0(a,c)+vec3f(2f)*quaternionMultiply_0(b,quaternionConjugate_0(a)).yzw;}
struct SurfaceVaryings_0{@builtin(position)position_0:vec4f,@location(0)normal_0:vec3f,@location(1)toCamera_0:vec3f,};
fn surfaceVaryings_0(a:vec3f,b:vec3f,c:vec3f,d:mat4x4f)->SurfaceVaryings_0{var e=c-a;var f=vec4f(a,1f)*d;var g=vec4f(a-e*vec3f(0.01f/max(length(e),1e-20f)),1f)*d;var h:SurfaceVaryings_0;var i=f.w;h.position_0=vec4f(f.xy,i*g.z/max(g.w,1e-20f),i);h.normal_0=b/vec3f(max(length(b),1e-20f));h.toCamera_0=e;return h;}
fn surfaceVertex_0(a:u32)->vec3f{var b=3u*a;var c=2u*a;return dualTransform_0(vertex_dq_0[c],vertex_dq_0[c+1u],vec3f(mesh_0[b],mesh_0[b+1u],mesh_0[b+2u]));}
@vertex fn TemplateVert(@builtin(vertex_index)a:u32)->SurfaceVaryings_0{return surfaceVaryings_0(surfaceVertex_0(a),vec3f(),Constants_0.camera_0.xyz,mat4x4f(Constants_0.view_projection_0.data_0[0][0],Constants_0.view_projection_0.data_0[1][0],Constants_0.view_projection_0.data_0[2][0],Constants_0.view_projection_0.data_0[3][0],Constants_0.view_projection_0.data_0[0][1],Constants_0.view_projection_0.data_0[1][1],Constants_0.view_projection_0.data_0[2][1],Constants_0.view_projection_0.data_0[3][1],Constants_0.view_projection_0.data_0[0][2],Constants_0.view_projection_0.data_0[1][2],Constants_0.view_projection_0.data_0[2][2],Constants_0.view_projection_0.data_0[3][2],Constants_0.view_projection_0.data_0[0][3],Constants_0.view_projection_0.data_0[1][3],Constants_0.view_projection_0.data_0[2][3],Constants_0.view_projection_0.data_0[3][3]));}`,
};

/** @type {import("../shader.js").Shader} */
export const TemplateFrag = {
  ...{"stage":"frag","entry":"TemplateFrag","buffers":[],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":false},{"name":"camera","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":false},{"name":"color","offset":80,"scalar":"float","shape":[4],"strides":[4],"used":true}],"constants_binding":2,"threads":[1,1,1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)camera_0:vec4f,@align(16)color_0:vec4f,};
@binding(2)@group(1)var<uniform>Constants_0:Constants;
fn facetShade_0(a:vec3f,b:vec3f)->vec3f{var c=cross(dpdx(a),dpdy(a));return b*vec3f(0.28f+0.72f*abs(dot(c,a)/max(length(c)*length(a),1e-20f)));}
struct pixelOutput_0{@location(0)output_0:vec4f,};
struct pixelInput_0{@location(0)normal_1:vec3f,@location(1)toCamera_1:vec3f,};
@fragment fn TemplateFrag(a:pixelInput_0,@builtin(position)b:vec4f)->pixelOutput_0{var c=pixelOutput_0(vec4f(facetShade_0(a.toCamera_1,Constants_0.color_0.xyz),1f));return c;}`,
};
